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

/// Combines the channels of one topic: "feedback/3" becomes "feedback/*".
std::string grouped(const std::string& topic) {
  const std::size_t slash = topic.rfind('/');
  const bool is_channel =
      slash != std::string::npos && slash + 1 < topic.size() &&
      std::ranges::all_of(topic.substr(slash + 1), [](char c) { return c >= '0' && c <= '9'; });
  return is_channel ? topic.substr(0, slash) + "/*" : topic;
}

/// The first four bytes of a GUID: vendor and host ("01.0f.a3.5c").
std::string host_of(const std::string& guid) { return guid.substr(0, 11); }

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else if (c == '&')
      result += "&amp;";
    else
      result += c;
  }
  return result;
}

constexpr int kRow_px = 22, kLeft_px = 30, kProcess_px = 190, kRight_px = 560, kTopic_px = 200, kTop_px = 40;

std::string label(int x_px, int y_px, int width_px, const std::string& text, const char* fill) {
  return fmt::format(
      "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" rx=\"4\" fill=\"{}\"/><text x=\"{}\" "
      "y=\"{}\">{}</text>\n",
      x_px, y_px, width_px, kRow_px - 4, fill, x_px + 6, y_px + 13, escaped(text));
}

std::string line(int from_y_px, int to_y_px, const char* colour) {
  const int from_px = kLeft_px + kProcess_px, middle_px = (from_px + kRight_px) / 2;
  return fmt::format(
      "<path d=\"M{0} {1}C{2} {1} {2} {3} {4} {3}\" fill=\"none\" stroke=\"{5}\" stroke-opacity=\"0.6\"/>\n",
      from_px, from_y_px, middle_px, to_y_px, kRight_px, colour);
}

}  // namespace

ProcessGraph graph_of(const std::vector<DiscoveredEndpoint>& endpoints) {
  ProcessGraph graph;
  std::map<std::pair<std::string, std::string>, ProcessGraph::Process> processes;  // indexed by host and name
  std::set<std::string> topics;
  for (const DiscoveredEndpoint& endpoint : endpoints) {
    const std::string host = host_of(endpoint.guid), topic = grouped(endpoint.topic);
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

std::string to_svg(const ProcessGraph& graph) {
  const int rows = static_cast<int>(std::max(graph.processes.size(), graph.topics.size()));
  const int height_px = kTop_px + rows * kRow_px + 20, width_px = kRight_px + kTopic_px + 30;
  const auto row_px = [](std::size_t index) { return kTop_px + static_cast<int>(index) * kRow_px; };
  const auto topic_px = [&](const std::string& topic) {
    const auto found = std::ranges::lower_bound(graph.topics, topic);
    return row_px(static_cast<std::size_t>(found - graph.topics.begin())) + kRow_px / 2 - 2;
  };
  std::string hosts, lines, labels;
  for (std::size_t begin = 0, end = 0; begin < graph.processes.size(); begin = end) {
    while (end < graph.processes.size() && graph.processes[end].host == graph.processes[begin].host) ++end;
    hosts += fmt::format(
        "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" rx=\"6\" fill=\"none\" stroke=\"#999\" "
        "stroke-dasharray=\"4 3\"><title>host {}</title></rect>\n",
        kLeft_px - 8, row_px(begin) - 3, kProcess_px + 16, static_cast<int>(end - begin) * kRow_px + 2,
        escaped(graph.processes[begin].host));
  }
  for (std::size_t i = 0; i < graph.processes.size(); ++i) {
    const ProcessGraph::Process& process = graph.processes[i];
    const int y_px = row_px(i) + kRow_px / 2 - 2;
    for (const std::string& topic : process.writes) lines += line(y_px, topic_px(topic), "#d55e00");
    for (const std::string& topic : process.reads) lines += line(y_px + 3, topic_px(topic) + 3, "#0072b2");
    labels += label(kLeft_px, row_px(i), kProcess_px, process.name, "#dbe9f5");
  }
  for (std::size_t i = 0; i < graph.topics.size(); ++i)
    labels += label(kRight_px, row_px(i), kTopic_px, graph.topics[i], "#f3ead2");
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"sans-serif\" "
      "font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n<text x=\"{2}\" "
      "y=\"20\">processes, boxed by "
      "host</text>\n<text x=\"{3}\" y=\"20\">topics</text>\n<text x=\"300\" y=\"20\" "
      "fill=\"#d55e00\">writes</text>\n<text "
      "x=\"350\" y=\"20\" fill=\"#0072b2\">reads</text>\n{4}{5}{6}</svg>\n",
      width_px, height_px, kLeft_px, kRight_px, hosts, lines, labels);
}

}  // namespace sidestep
