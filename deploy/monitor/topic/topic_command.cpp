// SPDX-License-Identifier: Apache-2.0
#include "deploy/monitor/topic/topic_command.hpp"

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "common/process/process.hpp"
#include "deploy/monitor/topic/listen.hpp"

namespace sidestep {

CLI::App* add_topic_command(CLI::App& root, std::function<int()>& action) {
  CLI::App* topic = root.add_subcommand("topic", "Listens to the topics of a DDS domain");
  topic->require_subcommand(1);
  const auto options = std::make_shared<ListenOptions>();

  CLI::App* list = topic->add_subcommand("list", "Every topic: type, writers, readers, QoS, mismatches");
  list->add_option("--seconds", options->seconds, "how long to wait for announcements")
      ->check(CLI::PositiveNumber)
      ->default_val(2.0);
  list->callback([options, &action] { action = [options] { return list_topics(*options); }; });

  CLI::App* hz = topic->add_subcommand("hz", "Rate, gaps and bandwidth of a topic of any type");
  hz->add_option("TOPIC", options->topic, "e.g. feedback/3")->required();
  hz->add_option("--seconds", options->seconds, "how long to measure; without it until Ctrl-C")
      ->check(CLI::PositiveNumber);
  hz->callback([options, &action] { action = [options] { return measure_rate(*options); }; });

  CLI::App* echo = topic->add_subcommand("echo", "Prints messages, one line of JSON each");
  echo->add_option("TOPIC", options->topic, "e.g. feedback/3")->required();
  echo->add_option("--count", options->count, "how many; without it until Ctrl-C")
      ->check(CLI::PositiveNumber);
  echo->callback([options, &action] { action = [options] { return echo_topic(*options); }; });

  for (CLI::App* command : {list, hz, echo}) add_dds_options(*command, options->dds);
  return topic;
}

}  // namespace sidestep
