// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/topic/silence.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <set>

#include "deploy/inspect/record/bag.hpp"

namespace sidestep {
namespace {

std::string filtered_text(const std::string& topic, std::uint64_t received) {
  return fmt::format("none of the {} messages of '{}' passes --filter", received, topic);
}

std::string or_none(const std::set<std::string>& names) {
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, " "));
}

}  // namespace

std::string silence_text(const std::string& topic, int domain,
                         const std::vector<DiscoveredEndpoint>& endpoints, std::uint64_t received) {
  if (received > 0) return filtered_text(topic, received) + " so far";
  std::set<std::string> topics, writers;
  for (const DiscoveredEndpoint& endpoint : endpoints) {
    if (!endpoint.is_writer) continue;
    topics.insert(endpoint.topic);
    if (endpoint.topic == topic) writers.insert(endpoint.participant);
  }
  if (writers.empty())
    return fmt::format("no process in domain {} writes '{}' so far; topics that have a writer: {}", domain,
                       topic, or_none(topics));
  return fmt::format("'{}' has a writer in domain {} ({}), but no message so far", topic, domain,
                     fmt::join(writers, ", "));
}

std::string silence_text(const std::string& topic, const std::string& recording,
                         const std::vector<std::string>& channels, std::uint64_t received) {
  if (received > 0) return fmt::format("{}: {}", recording, filtered_text(topic, received));
  return fmt::format("{}: no message of '{}'; topics in this recording: {}", recording, topic,
                     or_none({channels.begin(), channels.end()}));
}

std::string recorded_silence_text(const std::string& topic, const std::string& recording_file,
                                  std::uint64_t received) {
  std::vector<std::string> channels;
  for (const auto& [channel, content] : bag_info(recording_file).channels) channels.push_back(channel);
  return silence_text(topic, recording_file, channels, received);
}

void explain_silence(DdsBus& bus, const TopicOptions& options, const std::function<bool()>& is_silent,
                     const std::function<std::uint64_t()>& received, Time end) {
  const Duration discovery = from_seconds(options.discovery_s);
  bus.run_until(std::min(end, bus.now() + discovery));
  if (!is_silent()) return;
  const DdsListener listener(options.dds);
  bus.run_until(bus.now() + discovery);
  if (is_silent())
    fmt::print(stderr, "{}{}\n",
               silence_text(options.topic, options.dds.domain, listener.endpoints(), received()),
               bus.now() < end ? "; waiting" : "");
}

std::string empty_domain_text(int domain) {
  return fmt::format("no process in domain {} writes or reads a topic so far", domain);
}

}  // namespace sidestep
