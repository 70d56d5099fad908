// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/topic/graph_picture.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <set>

#include "common/file/xml_text.hpp"
#include "common/svg/palette.hpp"
#include "common/svg/svg.hpp"
#include "deploy/inspect/topic/process_groups.hpp"

namespace sidestep {
namespace {

constexpr double kBox_px = 220, kTopic_px = 190, kGap_px = 170;  // widths
constexpr double kWriters_px = 30, kTopics_px = kWriters_px + kBox_px + kGap_px,
                 kReaders_px = kTopics_px + kTopic_px + kGap_px, kWidth_px = kReaders_px + kBox_px + 30;
constexpr double kTop_px = 96, kTopicRow_px = 28, kTopicBox_px = 22;
constexpr double kLine_px = 9;  // between the lines of one box
constexpr double kMinBox_px = 26, kNamedBox_px = 42, kBoxGap_px = 14, kHostGap_px = 26;
constexpr double kFont_px = 12, kSmallFont_px = 10.5;
constexpr std::size_t kMaxMismatches = 12;
constexpr const char *kQuiet = "#57606a", *kAlarm = "#b3122f";

using Lines = std::map<std::string, std::size_t>;  // number of members, indexed by topic

/// A group in one of the outer columns.
struct PlacedGroup {
  const GraphGroup* group;
  const Lines* lines;
  std::string colour;
  double top_px = 0, height_px = 0;
};

std::string cut(const std::string& text, double width_px, double font_px) {
  std::string shown = text;
  while (!shown.empty() && text_width_px(shown, font_px) > width_px) {
    // Removes the last character, of which UTF-8 may need several bytes.
    while (shown.size() > 1 && (static_cast<unsigned char>(shown.back()) & 0xC0) == 0x80) shown.pop_back();
    shown.pop_back();
  }
  return shown == text ? text : shown + "\xE2\x80\xA6";
}

/// A column of groups, from the top; `lines` are those of its side.
std::vector<PlacedGroup> column(const std::vector<GraphGroup>& groups, Lines GraphGroup::*lines,
                                const std::map<std::string, std::string>& colours) {
  std::vector<PlacedGroup> placed;
  double y_px = kTop_px;
  for (const GraphGroup& group : groups) {
    if ((group.*lines).empty()) continue;
    if (!placed.empty()) y_px += placed.back().group->host == group.host ? kBoxGap_px : kHostGap_px;
    const double height_px = std::max(group.members.size() > 1 ? kNamedBox_px : kMinBox_px,
                                      kLine_px * static_cast<double>((group.*lines).size()) + kLine_px);
    placed.push_back({&group, &(group.*lines), colours.at(group.kind), y_px, height_px});
    y_px += height_px;
  }
  return placed;
}

double bottom_of(const std::vector<PlacedGroup>& groups) {
  return groups.empty() ? kTop_px : groups.back().top_px + groups.back().height_px;
}

/// Spreads the groups of a column so that it ends there.
void spread(std::vector<PlacedGroup>& groups, double bottom_px) {
  const double missing_px = bottom_px - bottom_of(groups);
  const double gaps = static_cast<double>(groups.size()) - 1;
  for (std::size_t i = 0; i < groups.size(); ++i)
    groups[i].top_px += gaps > 0 ? missing_px * static_cast<double>(i) / gaps : missing_px / 2;
}

/// Sorts topics by the mean heights of their writers and readers, so that fewer lines cross.
std::vector<std::string> ordered_topics(const ProcessGraph& graph, const std::vector<PlacedGroup>& writers,
                                        const std::vector<PlacedGroup>& readers) {
  const auto mean_px = [](const std::vector<PlacedGroup>& groups, const std::string& topic) {
    double sum_px = 0, count = 0;
    for (const PlacedGroup& placed : groups) {
      if (!placed.lines->contains(topic)) continue;
      sum_px += placed.top_px + placed.height_px / 2;
      ++count;
    }
    return count > 0 ? sum_px / count : -1;
  };
  std::vector<std::string> topics = graph.topics;
  std::ranges::stable_sort(topics, {}, [&](const std::string& topic) {
    const double writers_px = mean_px(writers, topic), readers_px = mean_px(readers, topic);
    return writers_px < 0 ? readers_px : readers_px < 0 ? writers_px : (writers_px + readers_px) / 2;
  });
  return topics;
}

std::string box(double x_px, double y_px, double width_px, double height_px, const std::string& attributes) {
  return fmt::format("<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' rx='5' {}/>\n", x_px, y_px,
                     width_px, height_px, attributes);
}

std::string draw_group(const PlacedGroup& placed, double x_px) {
  const GraphGroup& group = *placed.group;
  const std::string members = members_text(group);
  const double middle_px = placed.top_px + placed.height_px / 2;
  std::string svg =
      fmt::format("<g><title>{}</title>\n", xml_escaped(fmt::format("{}", fmt::join(group.members, ", ")))) +
      box(x_px, placed.top_px, kBox_px, placed.height_px, fmt::format("fill='{}'", placed.colour));
  svg += svg_text({x_px + 10, middle_px + (members.empty() ? 4 : -3)},
                  cut(title_of(group), kBox_px - 20, kFont_px + 1),
                  "fill='white' font-size='13' font-weight='bold'");
  if (!members.empty())
    svg += svg_text({x_px + 10, middle_px + 13}, cut(members, kBox_px - 20, kSmallFont_px),
                    fmt::format("fill='white' font-size='{}'", kSmallFont_px));
  return svg + "</g>\n";
}

/// Lines between the groups of a column, from `x_px` on, and their topics.
std::string draw_lines(const std::vector<PlacedGroup>& groups, const std::vector<std::string>& topics,
                       const std::map<std::string, double>& topic_px, double x_px, double to_px) {
  std::string svg;
  for (const PlacedGroup& placed : groups) {
    const double step_px = placed.height_px / static_cast<double>(placed.lines->size() + 1);
    double y_px = placed.top_px;
    for (const std::string& topic : topics) {
      const auto line = placed.lines->find(topic);
      if (line == placed.lines->end()) continue;
      y_px += step_px;
      const std::size_t members = placed.group->members.size();
      svg += fmt::format(
          "<path d='M{0:.1f} {1:.1f}C{2:.1f} {1:.1f} {2:.1f} {3:.1f} {4:.1f} {3:.1f}' "
          "stroke='{5}'{6}><title>{7} of {8}: "
          "{9}</title></path>\n",
          x_px, y_px, (x_px + to_px) / 2, topic_px.at(topic), to_px, placed.colour,
          line->second < members ? " stroke-dasharray='5 4'" : "", line->second, members, xml_escaped(topic));
    }
  }
  return fmt::format("<g fill='none' stroke-width='1.6' stroke-opacity='0.75'>\n{}</g>\n", svg);
}

/// Boxes around the groups of each host, if there are several hosts.
std::string draw_hosts(const std::vector<PlacedGroup>& groups, double x_px) {
  std::string svg;
  for (std::size_t begin = 0, end = 0; begin < groups.size(); begin = end) {
    const std::string& host = groups[begin].group->host;
    while (end < groups.size() && groups[end].group->host == host) ++end;
    const double top_px = groups[begin].top_px,
                 bottom_px = groups[end - 1].top_px + groups[end - 1].height_px;
    svg += box(x_px - 8, top_px - 6, kBox_px + 16, bottom_px - top_px + 12,
               fmt::format("fill='none' stroke='{}' stroke-dasharray='4 3'", kQuiet)) +
           svg_text({x_px - 6, top_px - 9}, "host " + host,
                    fmt::format("fill='{}' font-size='{}'", kQuiet, kSmallFont_px));
  }
  return svg;
}

/// The topics whose readers and writers do not match.
std::set<std::string> mismatched_topics(const ProcessGraph& graph) {
  std::set<std::string> topics;
  for (const std::string& mismatch : graph.mismatches)
    topics.insert(without_channel(mismatch.substr(0, mismatch.find(':'))));
  return topics;
}

struct Drawn {
  std::string svg;
  double bottom_px;
};

Drawn draw_mismatches(const ProcessGraph& graph, double top_px) {
  Drawn drawn{"", top_px};
  const auto add = [&](const std::string& text) {
    drawn.bottom_px += 20;
    drawn.svg += svg_text({kWriters_px, drawn.bottom_px}, cut(text, kWidth_px - 2 * kWriters_px, kFont_px),
                          fmt::format("fill='{}'", kAlarm));
  };
  for (std::size_t i = 0; i < std::min(graph.mismatches.size(), kMaxMismatches); ++i)
    add("MISMATCH " + graph.mismatches[i]);
  if (graph.mismatches.size() > kMaxMismatches)
    add(fmt::format("and {} other mismatches", graph.mismatches.size() - kMaxMismatches));
  return drawn;
}

std::string headings(const ProcessGraph& graph, std::size_t hosts) {
  const auto count = [](std::size_t number, const char* noun, const char* plural) {
    return fmt::format("{} {}", number, number == 1 ? noun : plural);
  };
  const std::string heading = fmt::format("fill='{}' font-size='13'", kQuiet);
  return svg_text({kWriters_px, 28},
                  fmt::format("{} on {}, {}", count(graph.processes.size(), "process", "processes"),
                              count(hosts, "host", "hosts"), count(graph.topics.size(), "topic", "topics")),
                  "font-size='17' font-weight='bold'") +
         svg_text({kWriters_px, 48}, "Processes of one kind share a box. A dashed line: not all of them.",
                  heading) +
         svg_text({kWriters_px, 72}, "write", heading) + svg_text({kTopics_px, 72}, "topics", heading) +
         svg_text({kReaders_px, 72}, "read", heading);
}

}  // namespace

std::string graph_picture(const ProcessGraph& graph) {
  const std::vector<GraphGroup> groups = groups_of(graph);
  std::map<std::string, std::string> colours;  // indexed by kind
  std::set<std::string> hosts;
  for (const GraphGroup& group : groups) {
    colours.emplace(group.kind, distinct_colour(colours.size()));
    hosts.insert(group.host);
  }
  std::vector<PlacedGroup> writers = column(groups, &GraphGroup::writes, colours),
                           readers = column(groups, &GraphGroup::reads, colours);
  const double topics_px = kTopicRow_px * static_cast<double>(graph.topics.size());
  const double bottom_px = std::max({bottom_of(writers), bottom_of(readers), kTop_px + topics_px});
  spread(writers, bottom_px);
  spread(readers, bottom_px);
  const std::vector<std::string> topics = ordered_topics(graph, writers, readers);
  const std::set<std::string> mismatched = mismatched_topics(graph);
  std::map<std::string, double> topic_px;
  std::string boxes;
  const double row_px = (bottom_px - kTop_px) / static_cast<double>(std::max<std::size_t>(1, topics.size()));
  for (std::size_t i = 0; i < topics.size(); ++i) {
    const double y_px = kTop_px + row_px * static_cast<double>(i);
    topic_px[topics[i]] = y_px + kTopicBox_px / 2;
    const bool is_alarming = mismatched.contains(topics[i]);
    boxes += box(kTopics_px, y_px, kTopic_px, kTopicBox_px,
                 fmt::format("fill='#f3f4f6' stroke='{}' stroke-width='{}'", is_alarming ? kAlarm : "#8b949e",
                             is_alarming ? 2 : 1)) +
             svg_text({kTopics_px + 10, y_px + 15}, cut(topics[i], kTopic_px - 20, kFont_px),
                      fmt::format("font-size='{}'{}", kFont_px,
                                  is_alarming ? fmt::format(" fill='{}'", kAlarm) : ""));
  }
  std::string svg = headings(graph, hosts.size());
  if (hosts.size() > 1) svg += draw_hosts(writers, kWriters_px) + draw_hosts(readers, kReaders_px);
  svg += draw_lines(writers, topics, topic_px, kWriters_px + kBox_px, kTopics_px) +
         draw_lines(readers, topics, topic_px, kReaders_px, kTopics_px + kTopic_px) + boxes;
  for (const PlacedGroup& placed : writers) svg += draw_group(placed, kWriters_px);
  for (const PlacedGroup& placed : readers) svg += draw_group(placed, kReaders_px);
  const Drawn mismatches = draw_mismatches(graph, bottom_px + 10);
  return svg_document(kWidth_px, mismatches.bottom_px + 20, svg + mismatches.svg);
}

}  // namespace sidestep
