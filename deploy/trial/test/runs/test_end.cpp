// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/runs/test_end.hpp"

#include <algorithm>
#include <set>

namespace sidestep {
namespace {

// Time after the last deadline and arrival, for the final messages.
constexpr double kSettlingTime_s = 0.5;

std::vector<RobotId> arriving_robots(const FaultTest& test) {
  std::set<RobotId> expected;
  const std::vector<RobotId> roster = roster_of(test.scenario);
  std::set<RobotId> others(roster.begin(), roster.end());
  for (const Expectation& expectation : test.expectations) {
    if (const auto* arrived = std::get_if<ExpectArrived>(&expectation.check))
      expected.insert(arrived->robots.ids.begin(), arrived->robots.ids.end());
    if (const auto* not_arrived = std::get_if<ExpectNotArrived>(&expectation.check)) {
      for (const RobotId robot : not_arrived->robots.ids) others.erase(robot);
    }
  }
  const std::set<RobotId>& arriving = expected.empty() ? others : expected;
  return {arriving.begin(), arriving.end()};
}

}  // namespace

TestEnd::TestEnd(const FaultTest& test)
    : limit_s_(test.scenario.time_limit_s), arriving_(arriving_robots(test)) {
  for (const PlannedFault& fault : test.faults) decided_s_ = std::max(decided_s_, fault.end_s());
  for (const Expectation& expectation : test.expectations) {
    // Expected arrivals end the run when they happen, not at their deadline.
    if (!std::holds_alternative<ExpectArrived>(expectation.check))
      decided_s_ = std::max(decided_s_, deadline_s(expectation).value_or(0));
  }
  decided_s_ += kSettlingTime_s;
}

bool TestEnd::update(double at_s, const std::vector<RobotProgress>& progress) {
  const bool have_arrived = std::ranges::all_of(progress, [this](const RobotProgress& row) {
    return row.is_done || std::ranges::find(arriving_, row.robot) == arriving_.end();
  });
  arrived_since_s_ = have_arrived ? arrived_since_s_.value_or(at_s) : std::optional<double>();
  if (at_s >= std::max(limit_s_, decided_s_)) return true;
  return at_s >= decided_s_ && arrived_since_s_ && at_s - *arrived_since_s_ >= kSettlingTime_s;
}

}  // namespace sidestep
