// SPDX-License-Identifier: Apache-2.0
#include "deploy/monitor/audit/audit_path.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "common/messaging/codec.hpp"
#include "common/motion/clearance.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

namespace sidestep {

TEST_CASE("an audited path is where the system's own trajectory is") {
  const std::uint64_t seed = GENERATE(range(1, 20));
  CAPTURE(seed);
  Rng rng(seed);
  const Version version{0, 1, 2, 0, random_trajectory(rng), 0};
  const AuditPath path(encode(version));
  for (int i = 0; i < 200; ++i) {
    const Time t = version.trajectory.start() + from_seconds(3 * rng.uniform());
    const State there = version.trajectory.state_at(t);
    const AuditPath::Node node = path.at_ns(to_ns(t));
    CHECK(std::hypot(node.x - there.position_m.x(), node.y - there.position_m.y()) < 1e-9);
    CHECK(std::hypot(node.x - path.first().x, node.y - path.first().y) <= path.reach_m() + 1e-12);
  }
  CHECK(std::hypot(path.last().vx, path.last().vy) ==
        Approx(version.trajectory.residual_speed_mps()).margin(1e-9));
}

TEST_CASE("the nearest that two paths come is found to micrometres, where it is near enough to matter") {
  int near = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const Version a{0, 1, 2, 0, random_trajectory(rng), 0}, b{1, 1, 2, 0, random_trajectory(rng), 0};
    const double least = clearance_m(a.trajectory, b.trajectory, 0), enough = 0.5;
    const Approach found = nearest(AuditPath(encode(a)), AuditPath(encode(b)), enough);
    if (least < enough) {
      ++near;
      CHECK(found.distance_m == Approx(least).margin(3e-6));
    } else {
      CHECK(found.distance_m >= enough - 1e-9);
    }
  }
  CHECK(near > 20);
}

TEST_CASE("what no robot could mean is no version") {
  msg::Version version = encode({0, 1, 2, 0, Trajectory::resting(time_from_ns(5), {1, 1}), 0});
  CHECK(is_sane(version));
  SECTION("not a number") { version.x_m(std::nan("")); }
  SECTION("too many phases") { version.phase_count(200); }
  SECTION("a start before all time") { version.start_ns(-1); }
  SECTION("a phase of negative duration") {
    version.phase_count(1);
    version.phases()[0].duration_ns(-5);
  }
  SECTION("shrunk") { version.inflation_m(-0.1); }
  CHECK_FALSE(is_sane(version));
}

}  // namespace sidestep
