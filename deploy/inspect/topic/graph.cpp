// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/topic/graph.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <utility>

#include "deploy/inspect/topic/topic_table.hpp"

namespace sidestep {
namespace {

/// The host's name. A process of another vendor may not announce it; then the first four bytes of its GUID,
/// which contain its vendor and host ("01.0f.a3.5c").
std::string host_of(const DiscoveredEndpoint& endpoint) {
  return endpoint.host.empty() ? endpoint.guid.substr(0, 11) : endpoint.host;
}

}  // namespace

std::string without_channel(const std::string& topic) {
  const std::size_t slash = topic.rfind('/');
  const bool is_channel =
      slash != std::string::npos && slash + 1 < topic.size() &&
      std::ranges::all_of(topic.substr(slash + 1), [](char c) { return c >= '0' && c <= '9'; });
  return is_channel ? topic.substr(0, slash) + "/*" : topic;
}

ProcessGraph graph_of(const std::vector<DiscoveredEndpoint>& endpoints) {
  ProcessGraph graph;
  std::map<std::pair<std::string, std::string>, ProcessGraph::Process> processes;  // indexed by host and name
  std::set<std::string> topics;
  for (const DiscoveredEndpoint& endpoint : endpoints) {
    const std::string host = host_of(endpoint), topic = without_channel(endpoint.topic);
    const std::string name = endpoint.participant.empty() ? endpoint.guid : endpoint.participant;
    ProcessGraph::Process& process = processes[{host, name}];
    process.name = name;
    process.host = host;
    (endpoint.is_writer ? process.writes : process.reads).insert(topic);
    topics.insert(topic);
  }
  for (auto& [key, process] : processes) graph.processes.push_back(std::move(process));
  graph.topics.assign(topics.begin(), topics.end());
  graph.mismatches = mismatch_lines(endpoints);
  return graph;
}

std::string to_text(const ProcessGraph& graph) {
  std::string text, host;
  for (const ProcessGraph::Process& process : graph.processes) {
    if (process.host != host) {
      host = process.host;
      text += fmt::format("{}host {}\n", text.empty() ? "" : "\n", host);
    }
    text += fmt::format("  {}\n    writes {}\n    reads  {}\n", process.name,
                        process.writes.empty() ? "-" : fmt::format("{}", fmt::join(process.writes, " ")),
                        process.reads.empty() ? "-" : fmt::format("{}", fmt::join(process.reads, " ")));
  }
  for (const std::string& mismatch : graph.mismatches) text += "MISMATCH " + mismatch + "\n";
  return text;
}

}  // namespace sidestep
