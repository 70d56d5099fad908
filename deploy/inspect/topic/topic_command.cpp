// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/topic/topic_command.hpp"

#include <memory>
#include <string>

#include "common/process/command_line.hpp"
#include "common/process/process.hpp"
#include "deploy/inspect/topic/topic_tools.hpp"

namespace sidestep {

void add_topic_command(const CliCommand& root, std::function<int()>& action) {
  const CliCommand topic = root.add_subcommand("topic", "Inspects the topics of a DDS domain");
  topic.require_subcommand();
  const auto options = std::make_shared<TopicOptions>();
  options->dds.participant = "sidestep-topic";

  const CliCommand list =
      topic.add_subcommand("list", "Lists all topics: type, writers, readers, QoS, mismatches");
  list.add_option("--seconds", options->discovery_s, "duration of discovery")
      .check(positive())
      .show_default();
  list.on_parsed([options, &action] { action = [options] { return list_topics(*options); }; });

  const CliCommand hz =
      topic.add_subcommand("hz", "Measures rate, gaps and bandwidth of a topic of any type");
  hz.add_option("TOPIC", options->topic, "topic name, e.g. feedback/3").required();
  hz.add_option("--seconds", options->seconds, "duration [until Ctrl-C]").check(positive());
  hz.on_parsed([options, &action] { action = [options] { return measure_rate(*options); }; });

  const CliCommand bw = topic.add_subcommand(
      "bw", "Measures the bandwidth of a topic of any type, and the sizes of its messages");
  bw.add_option("TOPIC", options->topic, "topic name, e.g. feedback/3").required();
  bw.add_option("--seconds", options->seconds, "duration [until Ctrl-C]").check(positive());
  bw.on_parsed([options, &action] { action = [options] { return measure_bandwidth(*options); }; });

  const CliCommand info =
      topic.add_subcommand("info", "Shows a topic's type, and each of its writers and readers with its QoS");
  info.add_option("TOPIC", options->topic, "topic name, e.g. feedback/3").required();
  info.add_option("--seconds", options->discovery_s, "duration of discovery")
      .check(positive())
      .show_default();
  info.on_parsed([options, &action] { action = [options] { return show_topic(*options); }; });

  const CliCommand delay = topic.add_subcommand(
      "delay",
      "Measures the delay of messages from each sender of a topic, and counts lost and out-of-order ones");
  delay.add_option("TOPIC", options->topic, "topic name, e.g. feedback/3").required();
  delay.add_option("--seconds", options->seconds, "duration [until Ctrl-C]").check(positive());
  delay.add_option("--recording", options->recording_file,
                   "measure in this recording instead of a running system");
  delay.on_parsed([options, &action] { action = [options] { return measure_delay(*options); }; });

  const CliCommand echo =
      topic.add_subcommand("echo", "Prints the messages of a topic as JSON, one per line");
  echo.add_option("TOPIC", options->topic, "topic name, e.g. feedback/3").required();
  echo.add_option("--count", options->printer.count, "number of messages [until Ctrl-C]").check(positive());
  const auto is_once = std::make_shared<bool>(false);
  const auto filters = std::make_shared<std::vector<std::string>>();
  echo.add_flag("--once", *is_once, "print one message, like --count 1");
  echo.add_option("--filter", *filters,
                  "print only messages with these values, e.g. robot=3 or robot=3,header.sender=10000")
      .comma_separated();
  echo.add_flag("--csv", options->printer.is_csv, "print CSV, with a column for each member");
  echo.add_option("--recording", options->recording_file,
                  "print the messages of this recording instead of a running system's");
  const Option idl =
      echo.add_option("--idl", options->idl_file, "IDL file with the type of another program's topic");
  echo.add_option("--type", options->type, "name of the topic's type [as its writer announces it]")
      .needs(idl);
  echo.on_parsed([options, is_once, filters, &action] {
    if (*is_once) options->printer.count = 1;
    try {
      for (const std::string& filter : *filters)
        options->printer.filters.push_back(parse_message_filter(filter));
    } catch (const std::invalid_argument& error) {
      throw UsageError(std::string("--filter: ") + error.what());
    }
    if (!options->idl_file.empty() && !options->recording_file.empty())
      throw UsageError("--idl is for running systems: a recording holds the types of its topics");
    action = [options] { return echo_topic(*options); };
  });

  const CliCommand pub =
      topic.add_subcommand("pub", "Publishes a message, given as JSON, to a topic of any type");
  pub.add_option("TOPIC", options->topic, "topic name, e.g. order").required();
  pub.add_option("MESSAGE", options->message,
                 "JSON with the members of the type's IDL; omitted ones are 0, and those of the header "
                 "the operator's")
      .required();
  pub.add_option("--count", options->printer.count, "number of messages [1]").check(positive());
  pub.add_option("--rate", options->rate_hz, "messages per second").check(positive()).show_default();
  pub.add_option("--idl", options->idl_file, "IDL file with the type of another program's topic");
  pub.add_option("--type", options->type, "name of the topic's type [as its endpoints announce it]");
  pub.on_parsed([options, &action] {
    options->dds.identity = {Role::kOperator};
    action = [options] { return publish_topic(*options); };
  });

  for (const CliCommand& command : {list, info, hz, bw, delay, echo, pub})
    add_dds_options(command, options->dds);
}

}  // namespace sidestep
