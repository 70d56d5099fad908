// SPDX-License-Identifier: Apache-2.0
#include "vision/patterns/identifier.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

/// Maximum distance from the expected position: the radius of a robot.
constexpr double kPositionGate_m = 0.09;
constexpr double kRobotGate_rad = 0.8;  ///< maximum deviation from the expected heading
constexpr double kMaxRobotSpeed_mps = 3;
constexpr Duration kHistoryTimeout{500'000'000};

constexpr double kPositionTolerance_m = 0.02;

std::size_t count(const std::vector<bool>& flags) {
  return static_cast<std::size_t>(std::ranges::count(flags, true));
}

std::vector<bool> intersection(const std::vector<bool>& a, const std::vector<bool>& b) {
  std::vector<bool> result(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) result[i] = a[i] && b[i];
  return result;
}

std::size_t first_set(const std::vector<bool>& flags) {
  return static_cast<std::size_t>(std::ranges::find(flags, true) - flags.begin());
}

}  // namespace

Identifier::Identifier(std::span<const RosterEntry> roster) : roster_(roster.begin(), roster.end()) {}

/// The robots whose pattern matches, except those already identified in this frame by a pattern with more
/// dots.
Identifier::RosterMask Identifier::matching_robots(const DetectedPattern& pattern) const {
  RosterMask matches(roster_.size());
  for (std::size_t i = 0; i < roster_.size(); ++i) {
    const bool is_found = std::ranges::any_of(
        found_, [&](const IdentifiedRobot& found) { return found.robot == roster_[i].robot; });
    matches[i] = !is_found && pattern.matches(roster_[i].team, roster_[i].pattern);
  }
  return matches;
}

bool Identifier::is_within_gates(const ExpectedRobot& expected, const DetectedPattern& pattern) const {
  return (expected.pose.position_m - pattern.pose.position_m).norm() <= kPositionGate_m &&
         std::abs(wrapped_rad(expected.pose.heading_rad - pattern.pose.heading_rad)) <= kRobotGate_rad;
}

/// The robots expected at the position of a pattern. Two robots cannot occupy one position, so the pattern
/// belongs to one of them even if its dots show another robot.
Identifier::RosterMask Identifier::robots_expected_at(const DetectedPattern& pattern,
                                                      std::span<const ExpectedRobot> expected) const {
  RosterMask robots(roster_.size());
  for (const ExpectedRobot& one : expected) {
    if (!is_within_gates(one, pattern)) continue;
    const auto entry = std::ranges::find(roster_, one.robot, &RosterEntry::robot);
    if (entry != roster_.end()) robots[static_cast<std::size_t>(entry - roster_.begin())] = true;
  }
  return robots;
}

/// Robots that match this pattern and all earlier observations of the same unidentified robot.
Identifier::RosterMask Identifier::narrowed_by_history(Time captured_at, const DetectedPattern& pattern,
                                                       const RosterMask& matches) {
  std::erase_if(unidentified_, [&](const UnidentifiedRobot& one) {
    return captured_at - one.observed_at > kHistoryTimeout;
  });
  const auto distance_m = [&](const UnidentifiedRobot& one) {
    return (one.position_m - pattern.pose.position_m).norm();
  };
  const auto nearest = std::ranges::min_element(unidentified_, {}, distance_m);
  const bool is_known =
      nearest != unidentified_.end() &&
      distance_m(*nearest) <=
          std::min(kPositionGate_m,
                   kPositionTolerance_m +
                       kMaxRobotSpeed_mps * std::abs(to_seconds(captured_at - nearest->observed_at)));
  if (!is_known) {
    unidentified_.push_back({pattern.pose.position_m, captured_at, matches});
    return matches;
  }
  RosterMask remaining = intersection(matches, nearest->matches);
  if (count(remaining) == 0) remaining = matches;  // the earlier observations were of a different robot
  *nearest = {pattern.pose.position_m, captured_at, remaining};
  return remaining;
}

std::span<const IdentifiedRobot> Identifier::identify(Time captured_at,
                                                      std::span<const DetectedPattern> patterns,
                                                      std::span<const ExpectedRobot> expected) {
  found_.clear();
  for (const DetectedPattern& pattern : patterns) {
    RosterMask matches = matching_robots(pattern);
    const RosterMask expected_here = robots_expected_at(pattern, expected);
    const bool is_expected = count(expected_here) > 0;
    if (is_expected) matches = intersection(matches, expected_here);
    if (!is_expected && count(matches) > 1) matches = narrowed_by_history(captured_at, pattern, matches);
    if (count(matches) == 1) found_.push_back({roster_[first_set(matches)].robot, pattern});
  }
  return found_;
}

}  // namespace sidestep
