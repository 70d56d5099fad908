// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/audit_path.hpp"

#include <algorithm>
#include <cmath>

#include "common/messaging/version_codec.hpp"
#include "common/motion/clearance.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

namespace sidestep::audit_path_test {

TEST_CASE("an audit path agrees with the system's own trajectory") {
  const std::uint64_t seed = GENERATE(range(1, 20));
  CAPTURE(seed);
  Rng rng(seed);
  const Version version{0, 1, 2, 0, random_trajectory(rng), 0};
  const AuditPath path(encode(version));
  for (int i = 0; i < 200; ++i) {
    const Time t = version.trajectory.start() + from_seconds(3 * rng.uniform());
    const State expected = version.trajectory.state_at(t);
    const AuditPath::Node node = path.at_ns(to_ns(t));
    CHECK(std::hypot(node.x - expected.position_m.x(), node.y - expected.position_m.y()) < 1e-9);
    CHECK(std::hypot(node.x - path.first().x, node.y - path.first().y) <= path.reach_m() + 1e-12);
  }
  double reach_m = 0, max_speed_mps = 0;
  for (int i = 0; i < path.phase_count(); ++i) {
    const AuditPath::Node &begin = path.phase(i), &end = path.phase(i + 1);
    const double speed_mps = std::max(std::hypot(begin.vx, begin.vy), std::hypot(end.vx, end.vy));
    reach_m += speed_mps * (end.elapsed_s - begin.elapsed_s);
    max_speed_mps = std::max(max_speed_mps, speed_mps);
  }
  CHECK(path.reach_m() == Approx(reach_m));
  CHECK(path.max_speed_mps() == Approx(max_speed_mps));
  CHECK(std::hypot(path.last().vx, path.last().vy) ==
        Approx(version.trajectory.residual_speed_mps()).margin(1e-9));
}

TEST_CASE("the closest approach of two paths is found to micrometres below the cutoff") {
  int near = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const Version a{0, 1, 2, 0, random_trajectory(rng), 0}, b{1, 1, 2, 0, random_trajectory(rng), 0};
    const double expected_m = clearance_m(a.trajectory, b.trajectory, 0), cutoff_m = 0.5;
    const ClosestApproach found = closest_approach(AuditPath(encode(a)), AuditPath(encode(b)), cutoff_m);
    if (expected_m < cutoff_m) {
      ++near;
      CHECK(found.distance_m == Approx(expected_m).margin(3e-6));
    } else {
      CHECK(found.distance_m >= cutoff_m - 1e-9);
    }
  }
  CHECK(near > 20);
}

TEST_CASE("a fast approach after a long rest is found for either order of the paths and their starts") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const double off_m = rng.uniform(0.001, 0.009), way_m = rng.uniform(0.05, 0.4), fast_mps2 = 10;
    const auto after = [&](double seconds) { return time_from_ns(1'000'000'000) + from_seconds(seconds); };
    const Trajectory resting = Trajectory::resting(after(rng.uniform(0, 3)), {0, off_m});
    Trajectory passing(after(rng.uniform(0, 3)), State{{-way_m, 0}, {0, 0}});
    passing.append(from_seconds(rng.uniform(3, 4)), {0, 0});
    const Duration half = from_seconds(std::sqrt(2 * way_m / fast_mps2));
    passing.append(half, {fast_mps2, 0});
    passing.append(half, {-fast_mps2, 0});
    const AuditPath a(encode({0, 1, 2, 0, resting, 0})), b(encode({1, 1, 2, 0, passing, 0}));
    constexpr double kCutoff_m = 0.01;
    CHECK(closest_approach(a, b, kCutoff_m).distance_m == Approx(off_m).margin(3e-6));
    CHECK(closest_approach(b, a, kCutoff_m).distance_m == Approx(off_m).margin(3e-6));
  }
}

TEST_CASE("the time of the closest approach is found, and times before `from` are not searched") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const Version a{0, 1, 2, 0, random_trajectory(rng), 0}, b{1, 1, 2, 0, random_trajectory(rng), 0};
    const Time from = std::max(a.trajectory.start(), b.trajectory.start()) + from_seconds(rng.uniform(0, 1));
    const double cutoff_m = 0.5;
    const ClosestApproach found =
        closest_approach(AuditPath(encode(a)), AuditPath(encode(b)), cutoff_m, to_ns(from));
    const auto distance_m = [&](Time t) { return distance_at(a.trajectory, b.trajectory, t); };
    CHECK(time_from_ns(found.at_ns) >= from);
    CHECK(distance_m(time_from_ns(found.at_ns)) == Approx(found.distance_m).margin(1e-7));
    for (int ms = 0; ms < 3000; ++ms) {
      const double there_m = distance_m(from + from_seconds(ms * 1e-3));
      if (there_m < cutoff_m && there_m < found.distance_m - 1e-6) {
        CAPTURE(ms);
        CHECK(there_m >= found.distance_m);
        break;
      }
    }
  }
}

TEST_CASE("if two paths never come near each other, their distance is found at the later start") {
  // Both robots drive away from each other for a second and then rest.
  const auto away = [](double from_m, double speed_mps) {
    Trajectory trajectory(time_from_ns(1'000'000'000), {{from_m, 0}, {speed_mps, 0}});
    trajectory.append(from_seconds(2), {-speed_mps / 2, 0});
    return AuditPath(encode({0, 1, 2, 0, trajectory, 0}));
  };
  const ClosestApproach found = closest_approach(away(1, 2), away(-1, -2), 0.1);
  CHECK(found.distance_m == 2);
  CHECK(found.at_ns == 1'000'000'000);
}

TEST_CASE("two robots that brake slowly towards each other are found to come near") {
  int near = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const double angle_rad = rng.uniform(0, 6), cutoff_m = 0.02;
    const auto braking = [&](double sign) {
      const double speed_mps = rng.uniform(1, 3), seconds = rng.uniform(2, 20);
      // The robots meet at the origin, late in their motion.
      const double way_m = speed_mps * seconds / 2 * rng.uniform(0.8, 1);
      const Vec2 from_m = -sign * way_m * Vec2(1, 0) + Vec2(0, rng.uniform(-0.02, 0.02));
      Trajectory trajectory(time_from_ns(1'000'000'000) + from_seconds(rng.uniform(0, 1)),
                            {rotated(from_m, angle_rad), rotated({sign * speed_mps, 0}, angle_rad)});
      append_stop(trajectory, speed_mps / seconds);
      return trajectory;
    };
    const Trajectory a = braking(1), b = braking(-1);
    const double expected_m = clearance_m(a, b, 0);
    const ClosestApproach found = closest_approach(AuditPath(encode({0, 1, 2, 0, a, 0})),
                                                   AuditPath(encode({1, 1, 2, 0, b, 0})), cutoff_m);
    if (expected_m >= cutoff_m) continue;
    ++near;
    CHECK(found.distance_m == Approx(expected_m).margin(3e-6));
  }
  CHECK(near > 50);
}

TEST_CASE("implausible versions are rejected") {
  msg::Version version = encode({0, 1, 2, 0, Trajectory::resting(time_from_ns(5), {1, 1}), 0});
  version.phase_count(msg::MAX_PHASES);
  CHECK(is_sane(version));
  msg::MotionPhase& last = version.phases()[msg::MAX_PHASES - 1];
  const double sign = GENERATE(1, -1);
  SECTION("a number is NaN or infinite") {
    SECTION("the position") { version.x_m(std::nan("")); }
    SECTION("the speed") { version.vy_mps(std::nan("")); }
    SECTION("the inflation") { version.inflation_m(std::nan("")); }
    SECTION("the acceleration") { last.ax_mps2(std::nan("")); }
  }
  SECTION("there are too many phases") {
    version.phase_count(GENERATE(std::uint8_t{msg::MAX_PHASES + 1}, 200));
  }
  SECTION("the start time is negative") { version.start_ns(-1); }
  SECTION("the position is far from any floor") {
    version.x_m(sign * 9999), version.y_m(-sign * 9999);
    CHECK(is_sane(version));
    SECTION("in x") { version.x_m(sign * 10'001); }
    SECTION("in y") { version.y_m(sign * 10'001); }
  }
  SECTION("the speed is higher than any robot's") {
    version.vx_mps(sign * 99), version.vy_mps(-sign * 99);
    CHECK(is_sane(version));
    SECTION("in x") { version.vx_mps(sign * 101); }
    SECTION("in y") { version.vy_mps(sign * 101); }
  }
  SECTION("the acceleration of the last phase is higher than any robot's") {
    last.ax_mps2(sign * 999), last.ay_mps2(-sign * 999);
    CHECK(is_sane(version));
    SECTION("in x") { last.ax_mps2(sign * 1001); }
    SECTION("in y") { last.ay_mps2(sign * 1001); }
  }
  SECTION("a phase has a negative duration or lasts for more than a minute") {
    version.phases()[0].duration_ns(0), last.duration_ns(60'000'000'000);
    CHECK(is_sane(version));
    SECTION("the first phase") { version.phases()[0].duration_ns(-1); }
    SECTION("the last phase") { last.duration_ns(60'000'000'001); }
  }
  SECTION("the inflation is negative or larger than a robot") {
    version.inflation_m(10);
    CHECK(is_sane(version));
    version.inflation_m(GENERATE(-0.001, 10.001));
  }
  CHECK_FALSE(is_sane(version));
}

}  // namespace sidestep::audit_path_test
