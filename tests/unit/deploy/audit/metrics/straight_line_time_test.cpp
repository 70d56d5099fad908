// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/metrics/straight_line_time.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "tests/catch.hpp"

namespace sidestep::straight_line_time_test {

RobotSpec robot_to(const Vec2& goal_m, std::optional<double> limit_mps = {}) {
  Goal goal{goal_m};
  goal.speed_limit_mps = limit_mps;
  RobotSpec robot;
  robot.goals.push_back(goal);
  return robot;
}

/// Accelerates in small steps while the braking distance allows.
double integrated_s(double distance_m, const MotionLimits& limits) {
  constexpr double kStep_s = 1e-5;
  double x = 0, v = 0, t = 0;
  while (distance_m - x > 1e-6) {
    const bool may_accelerate = distance_m - x > v * v / (2 * limits.deceleration_mps2);
    v = may_accelerate ? std::min(limits.speed_mps, v + limits.acceleration_mps2 * kStep_s)
                       : std::max(1e-3, v - limits.deceleration_mps2 * kStep_s);
    x += v * kStep_s;
    t += kStep_s;
  }
  return t;
}

TEST_CASE("the straight-line time agrees with slow integration") {
  const MotionLimits limits;
  for (const double goal_m : {0.01, 0.5, 1.06, 1.07, 3.0, 12.0}) {
    CAPTURE(goal_m);
    CHECK(straight_line_time_s(robot_to({goal_m, 0}), limits) ==
          Approx(integrated_s(goal_m, limits)).margin(4e-3));
    MotionLimits slow = limits;
    slow.speed_mps = 0.5;
    CHECK(straight_line_time_s(robot_to({goal_m, 0}, 0.5), limits) ==
          Approx(integrated_s(goal_m, slow)).margin(4e-3));
  }
}

TEST_CASE("the lower one of the speed limits of a robot and its goal counts for the straight-line time") {
  const MotionLimits limits{.speed_mps = 1};
  const double unlimited_s = straight_line_time_s(robot_to({3, 4}), limits);
  CHECK(straight_line_time_s(robot_to({3, 4}, 2.0), limits) == unlimited_s);
  CHECK(straight_line_time_s(robot_to({3, 4}, 0.5), limits) > unlimited_s + 4);
}

TEST_CASE("the straight-line time via several goals respects the speed limit of each") {
  const MotionLimits limits;
  RobotSpec robot = robot_to({2, 0}, 0.5);
  robot.goals.push_back({{2, 3}});
  CHECK(straight_line_time_s(robot, limits) == Approx(straight_line_time_s(robot_to({2, 0}, 0.5), limits) +
                                                      straight_line_time_s(robot_to({3, 0}), limits)));
}

TEST_CASE("a robot without a goal, or at its goal, needs no time") {
  CHECK(straight_line_time_s(RobotSpec{}, MotionLimits{}) == 0);
  CHECK(straight_line_time_s(robot_to({0, 0}, 0.5), MotionLimits{}) == 0);
}

TEST_CASE("the straight-line ratio is the mean over robots that have arrived and have a way to drive") {
  const MotionLimits limits;
  const std::vector<RobotSpec> robots{robot_to({1, 0}), robot_to({3, 0}, 0.5), robot_to({2, 0}),
                                      robot_to({0, 0}), RobotSpec{}};
  const auto times = [&](std::size_t robot, double factor) {
    return std::optional(factor * straight_line_time_s(robots[robot], limits));
  };
  const std::vector<std::optional<double>> arrivals_s{times(0, 1.5), times(1, 2), {}, 4.0, 5.0};
  CHECK(straight_line_time_ratio(robots, arrivals_s, limits).value_or(0) == Approx(1.75));
  const std::vector<std::optional<double>> nobody(robots.size());
  CHECK_FALSE(straight_line_time_ratio(robots, nobody, limits));
  CHECK_FALSE(straight_line_time_ratio({}, {}, limits));
}

}  // namespace sidestep::straight_line_time_test
