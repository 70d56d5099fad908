// SPDX-License-Identifier: Apache-2.0
#include "agents/safety/uncontrolled_body.hpp"

#include <cmath>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::uncontrolled_body_test {

constexpr Time kNow = time_from_ns(1'000'000'000'000);
constexpr double kSeparation_m = 0.19;

Trajectory resting(double x, double y) { return Trajectory::resting(kNow, {x, y}); }

/// A robot that drives from a position at a velocity for some time, then brakes.
Trajectory driving(const Vec2& from, const Vec2& velocity, double seconds) {
  Trajectory trajectory(kNow, {from, velocity});
  trajectory.append(from_seconds(seconds), {0, 0});
  append_stop(trajectory, 5);
  return trajectory;
}

/// The body at x = 0 moves to the right. Its path widens by a tenth of the distance:
//
//            _______---
//   (o)->  --------------
//            ~~~~~~~---
UncontrolledBody moving(const Vec2& velocity = {1, 0}) {
  return {{{0, 0}, 0.09, kNow, 2, velocity}, kSeparation_m};
}

bool may_follow(const Trajectory& candidate, const Trajectory& stop, const UncontrolledBody& body) {
  return UncontrolledBodies({&body, 1}, &stop, candidate.start()).allow(candidate, kSeparation_m - 0.09, 5);
}

bool may_rest(double x, double y, const UncontrolledBody& body, const Trajectory& stop) {
  return may_follow(resting(x, y), stop, body);
}

TEST_CASE("the path of a body widens ahead of it and ends behind it") {
  const UncontrolledBody body = moving();
  CHECK(body.distance_from_path_m({0, 0.3}) == Approx(0.3));
  CHECK(body.distance_from_path_m({3, -0.4}) == Approx(0.4));
  CHECK(body.distance_from_path_m({-0.3, 0.4}) == Approx(0.5));
  CHECK(body.required_distance_m({0, 1}) == Approx(0.22));
  CHECK(body.required_distance_m({-1, 1}) == Approx(0.22));
  CHECK(body.required_distance_m({3, 1}) == Approx(0.52));
}

TEST_CASE("a body whose direction of motion is unknown is avoided on all sides") {
  const UncontrolledBody body = moving({0, 0});
  CHECK(body.distance_from_path_m({-0.3, 0.4}) == Approx(0.5));
  CHECK(body.required_distance_m({3, 1}) == Approx(0.4));
}

TEST_CASE("a robot may not come to rest in a body's path unless its stop would end nearer to the middle") {
  const Trajectory beside = resting(0, 5), within = resting(2, 0.1);
  CHECK(may_rest(2, 0.45, moving(), beside));
  CHECK_FALSE(may_rest(2, 0.35, moving(), beside));
  CHECK_FALSE(may_rest(50, 1, moving(), beside));
  CHECK(may_rest(-0.25, 0, moving(), beside));
  CHECK(may_rest(2, 0.1, moving(), within));
  CHECK(may_rest(2, 0.2, moving(), within));
  CHECK_FALSE(may_rest(2, 0.09, moving(), within));
  // Within the path, a robot may come nearer to the body only by as much as it moves out of the path.
  CHECK_FALSE(may_rest(1.9, 0.1, moving(), within));
  CHECK_FALSE(may_rest(1.8, 0.2, moving(), within));
  CHECK(may_rest(1.9, 0.21, moving(), within));
  CHECK(may_rest(2.5, 0.1, moving(), within));
  CHECK(UncontrolledBodies({}, nullptr, kNow).allow(resting(2, 0), 0.1, 5));
}

TEST_CASE("a robot may pass in front of a body that would hit the robot if it stopped") {
  // The robot crosses the path from below at x = 1.2 m.
  const UncontrolledBody body = moving({2, 0});
  const Trajectory stop = driving({1.2, -0.25}, {0, 1.6}, 0), across = driving({1.2, -0.25}, {0, 1.6}, 0.3);
  REQUIRE(std::abs(stop.rest_position_m().y()) < 0.1);
  REQUIRE(across.rest_position_m().y() > 0.4);
  CHECK(excess_distance_m(stop, kNow, body) < 0);
  CHECK(excess_distance_m(across, kNow, body) >= 0);
  CHECK_FALSE(is_passively_safe(across, body.reach, kSeparation_m - 0.09));
  CHECK(may_follow(across, stop, body));
  // The robot may also pass if only a later version takes it across the path.
  const Trajectory shorter = driving({1.2, -0.25}, {0, 1.6}, 0.05);
  CHECK(excess_distance_m(shorter, kNow, body) < 0);
  CHECK(may_follow(shorter, stop, body));
  // The robot may not pass if it can stop short of the path.
  const Trajectory short_stop = driving({1.2, -0.6}, {0, 1.6}, 0),
                   passing = driving({1.2, -0.6}, {0, 1.6}, 0.52);
  REQUIRE(excess_distance_m(short_stop, kNow, body) >= 0);
  CHECK_FALSE(may_follow(passing, short_stop, body));
}

TEST_CASE("a robot that cannot avoid a body completely may drive where the contact is less deep") {
  // The body hits the robot wherever it drives, but not equally deeply.
  const UncontrolledBody body = moving({2, 0});
  const Trajectory stop = driving({0.6, -0.2}, {0, 1.6}, 0);
  const double stop_m = excess_distance_m(stop, kNow, body);
  REQUIRE(stop_m < -0.1);
  bool has_better = false;
  for (double y_mps = -1.6; y_mps <= 1.6; y_mps += 0.1) {
    Trajectory candidate(kNow, stop.at_start());
    candidate.append(from_seconds(1.0 / 60), Vec2(0, 10 * y_mps));
    append_stop(candidate, 5);
    double best_m = -10;
    for (double longer_s = 0; longer_s <= 0.4; longer_s += 0.05) {
      Trajectory longer(kNow, stop.at_start());
      longer.append(from_seconds(1.0 / 60), Vec2(0, 10 * y_mps));
      longer.append(from_seconds(longer_s), Vec2(0, 0));
      append_stop(longer, 5);
      best_m = std::max(best_m, excess_distance_m(longer, kNow, body));
    }
    CAPTURE(y_mps, stop_m, best_m);
    if (best_m > stop_m + 0.011 && best_m < 0) has_better |= may_follow(candidate, stop, body);
    if (best_m < stop_m + 0.009) CHECK_FALSE(may_follow(candidate, stop, body));
  }
  CHECK(has_better);
}

TEST_CASE("a trajectory that avoids a body stays clear of it at every sampled instant") {
  const std::uint64_t seed = 5;
  CAPTURE(seed);
  Rng rng(seed);
  int avoided = 0, hit = 0;
  const auto vector = [&](double max) { return Vec2(rng.uniform(-max, max), rng.uniform(-max, max)); };
  for (int i = 0; i < 3000; ++i) {
    UncontrolledBody body = moving(vector(1.4));
    body.reach.position_m = vector(1);
    body.reach.observed_at = kNow - from_seconds(rng.uniform(0, 0.1));
    const Trajectory robot = driving(vector(1), vector(1.4), rng.uniform(0, 0.4));
    double least = 10;
    for (double t = 0; t < 6; t += 0.002) {
      const Time at = kNow + from_seconds(t);
      const Vec2 body_m =
          body.reach.position_m + to_seconds(at - body.reach.observed_at) * body.reach.velocity_mps;
      least = std::min(least, (robot.state_at(at).position_m - body_m).norm());
    }
    if (excess_distance_m(robot, kNow, body) >= 0) {
      ++avoided;
      REQUIRE(least > kSeparation_m);
    } else {
      hit += least < kSeparation_m;
    }
  }
  CHECK(avoided > 1000);
  CHECK(hit > 200);
}

}  // namespace sidestep::uncontrolled_body_test
