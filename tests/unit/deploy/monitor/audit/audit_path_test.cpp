// SPDX-License-Identifier: Apache-2.0
#include "deploy/monitor/audit/audit_path.hpp"

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

TEST_CASE("a fast approach after a long rest is found, whichever path starts first and whichever is fast") {
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

TEST_CASE("implausible versions are rejected") {
  msg::Version version = encode({0, 1, 2, 0, Trajectory::resting(time_from_ns(5), {1, 1}), 0});
  CHECK(is_sane(version));
  SECTION("not a number") { version.x_m(std::nan("")); }
  SECTION("too many phases") { version.phase_count(GENERATE(std::uint8_t{msg::MAX_PHASES + 1}, 200)); }
  SECTION("a start at a negative time") { version.start_ns(-1); }
  SECTION("a phase of negative duration") {
    version.phase_count(1);
    version.phases()[0].duration_ns(-5);
  }
  SECTION("negative inflation") { version.inflation_m(-0.1); }
  CHECK_FALSE(is_sane(version));
}

}  // namespace sidestep::audit_path_test
