// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/topic/topic_writer.hpp"

#include <fmt/core.h>

#include "deploy/inspect/topic/topic_table.hpp"

namespace sidestep {
namespace {

constexpr Duration kDiscoveryTimeout{5'000'000'000};  // participants announce themselves once per second
constexpr Duration kPollPeriod{50'000'000};

}  // namespace

std::optional<DiscoveredEndpoint> find_writer(DdsListener& listener, const TopicOptions& options) {
  const Time deadline = listener.now() + kDiscoveryTimeout;
  while (!listener.stopped() && listener.now() < deadline) {
    for (const DiscoveredEndpoint& endpoint : listener.endpoints()) {
      if (endpoint.is_writer && endpoint.topic == options.topic) return endpoint;
    }
    listener.run_until(listener.now() + kPollPeriod);
  }
  if (!listener.stopped()) print_missing_topic(options, "no writer", listener);
  return std::nullopt;
}

void print_missing_topic(const TopicOptions& options, const char* what, const DdsListener& listener) {
  const std::string known = topic_names(listener.endpoints());
  fmt::print(stderr, "topic '{}' has {} in domain {}; topics in this domain: {}\n", options.topic, what,
             options.dds.domain, known.empty() ? "none" : known);
}

}  // namespace sidestep
