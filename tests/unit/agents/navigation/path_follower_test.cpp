// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/path_follower.hpp"

#include <array>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::path_follower_test {

// (0, 0) ---- (100, 0)
//                |
//             (100, 60), the target
const std::vector<Vec2> kPath{{0, 0}, {100, 0}, {100, 60}};
constexpr PathFollowerSettings kSettings{10, 8, 20};

PathFollower follower() {
  PathFollower result(kSettings);
  result.follow(kPath, kPath.back());
  return result;
}

double distance_from_path(const Vec2& p) {
  double nearest = 1e9;
  for (int i = 0; i <= 1000; ++i)
    nearest = std::min({nearest, (p - Vec2(0.1 * i, 0)).norm(), (p - Vec2(100, 0.06 * i)).norm()});
  return nearest;
}

TEST_CASE("a path is replanned only when the target or the robot has left the plan") {
  PathFollower none(kSettings);
  CHECK(none.replan_reason({0, 0}, {5, 5}) == ReplanReason::kNoPath);
  CHECK(none.carrot({3, 4}) == Vec2(3, 4));
  int kept = 0, robot_left = 0, target_left = 0;
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    Rng rng(seed);
    const double x = rng.uniform(-20, 120), y = rng.uniform(-20, 80), shift = rng.uniform(0, 20),
                 turn = rng.uniform(-3, 3);
    const Vec2 robot(x, y), target = kPath.back() + shift * rotated({1, 0}, turn);
    const double off_path = distance_from_path(robot);
    CAPTURE(seed, x, y, shift, off_path);
    const ReplanReason reason = follower().replan_reason(robot, target);
    if (std::abs(off_path - kSettings.max_deviation) < 0.1 ||
        std::abs(shift - kSettings.max_target_shift) < 0.1)
      continue;
    if (shift > kSettings.max_target_shift) {
      REQUIRE(reason == ReplanReason::kTargetLeftPlan);
      ++target_left;
    } else if (off_path > kSettings.max_deviation) {
      REQUIRE(reason == ReplanReason::kRobotLeftPlan);
      ++robot_left;
    } else {
      REQUIRE(reason == ReplanReason::kNone);
      ++kept;
    }
  }
  CHECK(kept > 20);
  CHECK(robot_left > 20);
  CHECK(target_left > 20);
}

TEST_CASE("the carrot only moves forward along the path and stops at its end") {
  PathFollower follower = path_follower_test::follower();
  CHECK((follower.carrot({10, 3}) - Vec2(30, 0)).norm() < 1e-9);
  CHECK((follower.carrot({90, -2}) - Vec2(100, 10)).norm() < 1e-9);
  CHECK((follower.carrot({97, 30}) - Vec2(100, 50)).norm() < 1e-9);
  // The first segment has been driven, so a robot that is pushed back to it is off the plan.
  CHECK(follower.replan_reason({50, 0}, kPath.back()) == ReplanReason::kRobotLeftPlan);
  CHECK(follower.carrot({100, 55}) == Vec2(100, 60));
}

TEST_CASE("a robot that follows the carrot reaches the end close to the path") {
  PathFollower follower = path_follower_test::follower();
  Vec2 robot(0, 0);
  for (int step = 0; step < 400; ++step) {
    const Vec2 to_carrot = follower.carrot(robot) - robot;
    robot += std::min(1.0, to_carrot.norm()) * to_carrot.normalized();
    if ((robot - kPath.back()).norm() < 1) break;
    REQUIRE(distance_from_path(robot) < kSettings.max_deviation);
    REQUIRE(follower.replan_reason(robot, kPath.back()) == ReplanReason::kNone);
  }
  CHECK((robot - kPath.back()).norm() < 1);
}

}  // namespace sidestep::path_follower_test
