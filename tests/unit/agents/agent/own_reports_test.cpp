// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/own_reports.hpp"

#include "tests/catch.hpp"

namespace sidestep::own_reports_test {

constexpr double kDriftBound_m = 0.003;

RobotReport at(const Vec2& position) {
  RobotReport robot_report;
  robot_report.estimate.position_m = position;
  robot_report.uncertainty = {0.0002, 0.01};
  return robot_report;
}

TEST_CASE("a robot that has not reported yet is at its start and may not drive") {
  const OwnReports own({{1, 2}, {0, 0}}, kDriftBound_m);
  CHECK(own.estimate().position_m == Vec2(1, 2));
  CHECK(own.dead_reckoning_m({1, 2}) == 0);
  CHECK_FALSE(own.has_moved());
}

TEST_CASE("planned motion reduces the distance that a robot may drive unobserved") {
  OwnReports own({}, kDriftBound_m);
  own.on_robot_report(at({1, 0}));
  const double whole_m = own.dead_reckoning_m({1, 0});
  REQUIRE(whole_m > 0.01);
  CHECK(own.dead_reckoning_m({1.01, 0}) == Approx(whole_m - 0.01));
  CHECK(own.dead_reckoning_m({1 + 2 * whole_m, 0}) == 0);
}

TEST_CASE("an estimate agrees with an observation within the drift bound") {
  OwnReports own({}, kDriftBound_m);
  own.on_robot_report(at({1, 0}));
  CHECK(own.agrees_with({1.0029, 0}));
  CHECK_FALSE(own.agrees_with({1.0031, 0}));
  CHECK_FALSE(own.agrees_with({1, -0.0031}));
}

TEST_CASE("a robot that has ever moved counts as having moved, even after a restart") {
  OwnReports own({}, kDriftBound_m);
  RobotReport moved = at({0, 0});
  moved.has_moved = true;
  own.on_robot_report(moved);
  own.on_robot_report(at({0, 0}));
  CHECK(own.has_moved());
}

}  // namespace sidestep::own_reports_test
