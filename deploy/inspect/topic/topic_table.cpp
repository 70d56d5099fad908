// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/topic/topic_table.hpp"

#include <algorithm>
#include <array>
#include <fmt/core.h>
#include <map>
#include <set>
#include <stdexcept>

#include "common/messaging/message_schema.hpp"

namespace sidestep {
namespace {

using Group = std::vector<const DiscoveredEndpoint*>;

std::map<std::string, Group> by_topic(const std::vector<DiscoveredEndpoint>& endpoints) {
  std::map<std::string, Group> result;
  for (const DiscoveredEndpoint& endpoint : endpoints) result[endpoint.topic].push_back(&endpoint);
  return result;
}

std::string name_of(const DiscoveredEndpoint& endpoint) {
  return endpoint.participant.empty() ? endpoint.guid : endpoint.participant;
}

template <typename Container>
std::string join(const Container& words, const char* separator) {
  std::string result;
  for (const std::string& word : words) result += (result.empty() ? "" : separator) + word;
  return result;
}

/// E.g. "23: agent-0, agent-1, agent-10, ...": a large fleet fits on one line.
std::string names(const Group& group, bool is_writer) {
  constexpr std::size_t kMaxNames = 3;
  std::vector<std::string> all;
  for (const DiscoveredEndpoint* endpoint : group) {
    if (endpoint->is_writer == is_writer) all.push_back(name_of(*endpoint));
  }
  if (all.empty()) return "-";
  const std::size_t count = all.size();
  if (count > kMaxNames) {
    all.resize(kMaxNames);
    all.emplace_back("...");
  }
  return fmt::format("{}: {}", count, join(all, ", "));
}

std::string types(const Group& group) {
  std::set<std::string> all;
  for (const DiscoveredEndpoint* endpoint : group) all.insert(endpoint->type);
  return join(all, " | ");
}

std::string qos(const Group& group) {
  std::set<std::string> all;
  for (const DiscoveredEndpoint* endpoint : group) {
    std::string words = endpoint->is_reliable ? "reliable" : "best effort";
    if (endpoint->durability != DiscoveredEndpoint::Durability::kVolatile) words += ", durable";
    if (endpoint->is_keyed) words += ", keyed";
    all.insert(words);
  }
  return join(all, " | ");
}

/// One line per reason, with the pairs of endpoints that it keeps from communicating.
std::vector<std::string> mismatches(const Group& group) {
  std::map<std::string, std::set<std::string>> pairs;
  for (const DiscoveredEndpoint* writer : group) {
    for (const DiscoveredEndpoint* reader : group) {
      if (!writer->is_writer || reader->is_writer) continue;
      for (const std::string& reason : qos_mismatches(*writer, *reader)) {
        pairs[reason].insert(name_of(*writer) + " -> " + name_of(*reader));
      }
    }
  }
  std::vector<std::string> result;
  result.reserve(pairs.size());
  for (const auto& [reason, endpoints] : pairs)
    result.push_back(fmt::format("{} ({})", reason, join(endpoints, ", ")));
  return result;
}

std::string mismatch_text(const Group& group) {
  std::string text;
  for (const std::string& mismatch : mismatches(group)) text += "  MISMATCH " + mismatch + "\n";
  return text;
}

}  // namespace

std::string topic_table(const std::vector<DiscoveredEndpoint>& endpoints) {
  using Row = std::array<std::string, 5>;
  const Row title = {"TOPIC", "TYPE", "WRITERS", "READERS", "QOS"};
  std::vector<Row> rows{title};
  std::vector<std::string> notes{""};
  for (const auto& [topic, group] : by_topic(endpoints)) {
    rows.push_back({topic, types(group), names(group, true), names(group, false), qos(group)});
    notes.push_back(mismatch_text(group));
  }
  std::array<std::size_t, 4> widths{};
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < widths.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string result;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    result += fmt::format("{:{}}  {:{}}  {:{}}  {:{}}  {}\n{}", row[0], widths[0], row[1], widths[1], row[2],
                          widths[2], row[3], widths[3], row[4], notes[i]);
  }
  return result;
}

std::string topic_details(const std::vector<DiscoveredEndpoint>& endpoints, const std::string& topic) {
  Group group;
  for (const DiscoveredEndpoint& endpoint : endpoints)
    if (endpoint.topic == topic) group.push_back(&endpoint);
  if (group.empty()) return "";
  std::string result = fmt::format("{}: {}\n", topic, types(group));
  for (const bool is_writer : {true, false})
    for (const DiscoveredEndpoint* endpoint : group)
      if (endpoint->is_writer == is_writer)
        result += fmt::format("{} {}: {}\n", is_writer ? "writer" : "reader", name_of(*endpoint),
                              qos_text(*endpoint));
  result += mismatch_text(group);
  try {
    result += '\n' + message_schema(group.front()->type);
  } catch (const std::invalid_argument&) {
    // DDS reports only the name of another program's type.
  }
  return result;
}

std::vector<std::string> mismatch_lines(const std::vector<DiscoveredEndpoint>& endpoints) {
  std::vector<std::string> lines;
  for (const auto& [topic, group] : by_topic(endpoints))
    for (const std::string& mismatch : mismatches(group))
      lines.push_back(fmt::format("{}: {}", topic, mismatch));
  return lines;
}

std::string topic_names(const std::vector<DiscoveredEndpoint>& endpoints) {
  std::vector<std::string> names;
  for (const auto& [topic, group] : by_topic(endpoints)) names.push_back(topic);
  return join(names, " ");
}

}  // namespace sidestep
