// SPDX-License-Identifier: Apache-2.0
#include "vision/patterns/identifier.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

constexpr double kSeenBeside_m = 0.02;

std::size_t count(const std::vector<bool>& flags) {
  return static_cast<std::size_t>(std::ranges::count(flags, true));
}

std::vector<bool> both(const std::vector<bool>& a, const std::vector<bool>& b) {
  std::vector<bool> result(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) result[i] = a[i] && b[i];
  return result;
}

std::size_t only(const std::vector<bool>& flags) {
  return static_cast<std::size_t>(std::ranges::find(flags, true) - flags.begin());
}

}  // namespace

Identifier::Identifier(std::span<const RosterEntry> roster, const IdentifierSettings& settings)
    : roster_(roster.begin(), roster.end()), settings_(settings) {}

/// Who is seen elsewhere in the frame, by more dots, is not here.
std::vector<bool> Identifier::fitting(const MarkedRobot& seen) const {
  std::vector<bool> fits(roster_.size());
  for (std::size_t i = 0; i < roster_.size(); ++i) {
    const bool is_found = std::ranges::any_of(
        found_, [&](const IdentifiedRobot& found) { return found.robot == roster_[i].robot; });
    fits[i] = !is_found && seen.can_be(roster_[i].team, roster_[i].pattern);
  }
  return fits;
}

bool Identifier::is_expected_at(const ExpectedRobot& expected, const MarkedRobot& seen) const {
  return (expected.pose.position_m - seen.pose.position_m).norm() <= settings_.gate_m &&
         std::abs(wrapped_rad(expected.pose.heading_rad - seen.pose.heading_rad)) <= settings_.gate_rad;
}

/// Two cannot stand in one place: who is expected there is who is there, or the dots were misread.
std::vector<bool> Identifier::expected_there(const MarkedRobot& seen,
                                             std::span<const ExpectedRobot> expected) const {
  std::vector<bool> there(roster_.size());
  for (const ExpectedRobot& one : expected) {
    if (!is_expected_at(one, seen)) continue;
    const auto entry = std::ranges::find(roster_, one.robot, &RosterEntry::robot);
    if (entry != roster_.end()) there[static_cast<std::size_t>(entry - roster_.begin())] = true;
  }
  return there;
}

/// Who it may be by all that was seen of it so far.
std::vector<bool> Identifier::remembered(Time captured_at, const MarkedRobot& seen, std::vector<bool> fits) {
  std::erase_if(nameless_,
                [&](const Nameless& one) { return captured_at - one.seen_at > settings_.forgets_after; });
  const auto distance_m = [&](const Nameless& one) { return (one.position_m - seen.pose.position_m).norm(); };
  const auto nearest = std::ranges::min_element(nameless_, {}, distance_m);
  const bool is_known =
      nearest != nameless_.end() &&
      distance_m(*nearest) <=
          std::min(
              settings_.gate_m,
              kSeenBeside_m + settings_.speed_mps * std::abs(to_seconds(captured_at - nearest->seen_at)));
  if (!is_known) {
    nameless_.push_back({seen.pose.position_m, captured_at, fits});
    return fits;
  }
  std::vector<bool> left = both(fits, nearest->may_be);
  if (count(left) == 0) left = fits;  // it was somebody else
  *nearest = {seen.pose.position_m, captured_at, left};
  return left;
}

std::span<const IdentifiedRobot> Identifier::identify(Time captured_at, std::span<const MarkedRobot> seen,
                                                      std::span<const ExpectedRobot> expected) {
  found_.clear();
  for (const MarkedRobot& robot : seen) {
    std::vector<bool> fits = fitting(robot);
    const std::vector<bool> there = expected_there(robot, expected);
    const bool is_expected = count(there) > 0;
    if (is_expected) fits = both(fits, there);
    if (!is_expected && count(fits) > 1) fits = remembered(captured_at, robot, std::move(fits));
    if (count(fits) == 1) found_.push_back({roster_[only(fits)].robot, robot});
  }
  return found_;
}

}  // namespace sidestep
