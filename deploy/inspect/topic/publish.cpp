// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <optional>

#include "common/file/console.hpp"
#include "common/json/json_text.hpp"
#include "common/messaging/dds/listener.hpp"
#include "common/messaging/dds/raw_publisher.hpp"
#include "common/messaging/message_schema.hpp"
#include "common/messaging/operator_header.hpp"
#include "common/process/process.hpp"
#include "common/process/stop_signals.hpp"
#include "deploy/inspect/topic/idl/idl_encoder.hpp"
#include "deploy/inspect/topic/idl/idl_parser.hpp"
#include "deploy/inspect/topic/omitted_header.hpp"
#include "deploy/inspect/topic/topic_channel.hpp"
#include "deploy/inspect/topic/topic_tools.hpp"
#include "deploy/inspect/topic/unmatched_readers.hpp"

namespace sidestep {
namespace {

constexpr Duration kAnswerTimeout = std::chrono::seconds(5);
constexpr Duration kStep = std::chrono::milliseconds(10);

/// The message that the user gives, its type and its key.
struct GivenMessage {
  IdlTypePtr type;
  nlohmann::ordered_json json;
  CdrKey key;

  std::vector<std::uint8_t> encoded(const msg::Header& header) const {
    return encode_by_idl(*type, with_header(*type, json, header));
  }
};

/// Throws std::invalid_argument if the type is unknown, the message does not fit it, or all processes would
/// refuse it.
GivenMessage checked_message(const TopicOptions& options, const IdlTypes& types, const std::string& name,
                             const nlohmann::ordered_json& json) {
  const auto type = types.find(name);
  if (type == types.end())
    throw std::invalid_argument(
        fmt::format("there is no type {} in {}", name,
                    options.idl_file.empty() ? "Sidestep's IDL; see --idl" : options.idl_file));
  GivenMessage message{type->second, json, key_by_idl(*type->second, json)};
  (void)message.encoded({});
  if (const std::string problem = sender_problem(*message.type, json, options.topic); !problem.empty())
    throw std::invalid_argument(problem);
  return message;
}

/// The name of a topic's type, if the user gives it or the topic is Sidestep's; nullopt otherwise.
std::optional<std::string> known_type_name(const TopicOptions& options) {
  if (!options.type.empty()) return options.type;
  for (const TopicInfo& topic : all_topics())
    if (channel_robot(topic, options.topic)) return topic.type.name;
  return std::nullopt;
}

/// The name of a topic's type, as an endpoint in the domain announces it.
std::string announced_type_name(const TopicOptions& options, const DdsListener& listener) {
  for (const DiscoveredEndpoint& endpoint : listener.endpoints())
    if (endpoint.topic == options.topic) return endpoint.type;
  throw std::invalid_argument(fmt::format(
      "topic '{}' is neither Sidestep's nor in this domain; give its type with --type", options.topic));
}

/// Waits until all known readers of the topic match the publisher, because a message reaches no others.
/// Returns false, and says which do not, if the time is over, or if there is none.
bool wait_for_readers(const std::string& topic, const PublishedType& type, DdsListener& listener,
                      const DdsRawPublisher& publisher) {
  const Time deadline = listener.now() + kAnswerTimeout;
  std::set<std::string> matched;
  std::vector<std::string> missing;
  const auto are_all_matched = [&] {
    matched = publisher.readers();
    missing = unmatched_readers(listener.endpoints(), topic, type, matched);
    return !matched.empty() && missing.empty();
  };
  while (!are_all_matched() && listener.now() < deadline && !listener.stopped())
    listener.run_until(listener.now() + kStep);
  if (missing.empty() && !matched.empty()) return true;
  if (missing.empty())
    fmt::print(stderr, "topic '{}' has no matching reader\n", topic);
  else
    fmt::print(stderr, "not sent: only {} of {} readers of '{}' match: not {}\n", matched.size(),
               matched.size() + missing.size(), topic, fmt::join(missing, ", "));
  return false;
}

}  // namespace

int publish_topic(const TopicOptions& options) {
  const auto json = parse_ordered_json(options.message, false);
  if (json.is_discarded()) throw std::invalid_argument("MESSAGE: is not valid JSON");
  const IdlTypes types = options.idl_file.empty() ? parse_idl(kIdlText, "idl") : load_idl(options.idl_file);
  std::optional<std::string> name = known_type_name(options);
  std::optional<GivenMessage> message;
  // Where possible, errors in the message are reported before the network is touched.
  if (name) message = checked_message(options, types, *name, json);
  DdsListener listener(options.dds);
  const StopSignals stop_signals([&listener] { listener.stop(); });
  listener.run_until(listener.now() + from_seconds(options.discovery_s));
  if (!message) {
    name = announced_type_name(options, listener);
    message = checked_message(options, types, *name, json);
  }
  DdsRawPublisher publisher(options.dds, options.topic, *name, is_keyed(*message->type));
  if (!wait_for_readers(options.topic, {*name, is_keyed(*message->type)}, listener, publisher))
    return kExitFailure;
  const std::uint64_t count = std::max<std::uint64_t>(options.printer.count, 1);
  const Time begun = listener.now();
  for (std::uint64_t i = 0; i < count && !listener.stopped(); ++i) {
    if (i > 0) listener.run_until(listener.now() + from_seconds(1 / options.rate_hz));
    publisher.write(message->encoded(operator_header(begun, i + 1, listener.now())), message->key);
  }
  if (!publisher.wait_until_acknowledged(kAnswerTimeout)) {
    fmt::print(stderr, "not all readers have acknowledged\n");
    return kExitFailure;
  }
  print_output("sent to {} reader(s)\n", publisher.readers().size());
  return 0;
}

}  // namespace sidestep
