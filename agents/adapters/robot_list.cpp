// SPDX-License-Identifier: Apache-2.0
#include "agents/adapters/robot_list.hpp"

#include <charconv>
#include <fmt/format.h>
#include <set>
#include <sstream>
#include <stdexcept>

namespace sidestep {
namespace {

std::optional<RobotId> number(const std::string& text) {
  RobotId id = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, id);
  return error == std::errc{} && rest == end && id < kMaxRobots ? std::optional(id) : std::nullopt;
}

}  // namespace

std::vector<RobotId> select_robots(const Scenario& scenario, const std::string& text) {
  if (text == "all") return roster_of(scenario);
  std::set<RobotId> selected;
  std::istringstream parts(text + ",");
  for (std::string part; std::getline(parts, part, ',');) {
    const auto dash = part.find('-');
    const auto first = number(part.substr(0, dash)),
               last = dash == std::string::npos ? first : number(part.substr(dash + 1));
    if (!first || !last || *last < *first)
      throw std::invalid_argument(
          fmt::format("--robots: expected numbers and ranges such as 0-10,16, got \"{}\"", part));
    for (RobotId id = *first; id <= *last; ++id) {
      if (!find_robot(scenario, id))
        throw std::invalid_argument(fmt::format("--robots: scenario {} has no robot {}", scenario.name, id));
      selected.insert(id);
    }
  }
  return {selected.begin(), selected.end()};
}

}  // namespace sidestep
