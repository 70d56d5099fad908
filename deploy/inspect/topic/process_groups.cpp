// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/topic/process_groups.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

namespace sidestep {
namespace {

constexpr const char *kAgent = "agent", *kCoordinator = "coordinator", *kTool = "tool";
constexpr std::string_view kOurPrefix = "sidestep-";
/// Parts of the system, in the order in which a picture shows them. Other names follow, tools at the end.
constexpr std::array kParts{kAgent, kCoordinator, "vision", "simulator", "robots"};

/// A name without the number at its end, and the number: "agent-3" is "agent" and 3.
struct NumberedName {
  std::string name;
  std::optional<unsigned> number;
};

NumberedName split(const std::string& name) {
  const std::size_t dash = name.rfind('-');
  unsigned number = 0;
  if (dash == std::string::npos || dash == 0 || dash + 1 == name.size()) return {name, std::nullopt};
  const char *begin = name.data() + dash + 1, *end = name.data() + name.size();
  const auto result = std::from_chars(begin, end, number);
  if (result.ec != std::errc() || result.ptr != end) return {name, std::nullopt};
  return {name.substr(0, dash), number};
}

bool is_part(std::string_view name) { return std::ranges::find(kParts, name) != kParts.end(); }

std::string kind_of(const std::string& process) {
  std::string name = split(process).name;
  if (!name.starts_with(kOurPrefix)) return name;
  name = name.substr(kOurPrefix.size());
  return is_part(name) ? name : kTool;
}

std::size_t rank_of(const std::string& kind) {
  if (kind == kTool) return kParts.size() + 1;
  return static_cast<std::size_t>(std::ranges::find(kParts, kind) - kParts.begin());
}

std::string ranges_text(const std::set<unsigned>& numbers) {
  std::vector<std::string> ranges;
  for (auto first = numbers.begin(); first != numbers.end();) {
    auto last = first;
    while (std::next(last) != numbers.end() && *std::next(last) == *last + 1) ++last;
    ranges.push_back(first == last ? fmt::format("{}", *first) : fmt::format("{}-{}", *first, *last));
    first = std::next(last);
  }
  return fmt::format("{}", fmt::join(ranges, ", "));
}

}  // namespace

std::vector<GraphGroup> groups_of(const ProcessGraph& graph) {
  std::vector<GraphGroup> groups;
  for (const ProcessGraph::Process& process : graph.processes) {
    const std::string kind = kind_of(process.name);
    auto group = std::ranges::find_if(
        groups, [&](const GraphGroup& known) { return known.host == process.host && known.kind == kind; });
    if (group == groups.end()) {
      groups.push_back({process.host, kind, {}, {}, {}});
      group = std::prev(groups.end());
    }
    group->members.push_back(process.name);
    for (const std::string& topic : process.writes) ++group->writes[topic];
    for (const std::string& topic : process.reads) ++group->reads[topic];
  }
  for (GraphGroup& group : groups)
    std::ranges::sort(group.members, {}, [](const std::string& name) {
      return std::pair(split(name).number.value_or(0), name);
    });
  std::ranges::stable_sort(
      groups, {}, [](const GraphGroup& group) { return std::pair(group.host, rank_of(group.kind)); });
  return groups;
}

std::string title_of(const GraphGroup& group) {
  if (group.members.size() == 1) return group.members.front();
  const bool is_plural = group.kind.ends_with('s');
  return fmt::format("{} {}{}", group.members.size(), group.kind, is_plural ? "" : "s");
}

std::string members_text(const GraphGroup& group) {
  if (group.members.size() == 1) return {};
  std::set<unsigned> numbers;
  std::vector<std::string> names;
  for (const std::string& member : group.members) {
    if (const auto number = split(member).number) numbers.insert(*number);
    names.push_back(member.starts_with(kOurPrefix) ? member.substr(kOurPrefix.size()) : member);
  }
  const bool are_numbered = group.kind != kTool && numbers.size() == group.members.size();
  return are_numbered ? ranges_text(numbers) : fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace sidestep
