// SPDX-License-Identifier: Apache-2.0
#include "agents/safety/keep_out.hpp"

#include "agents/safety/safety_search.hpp"
#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::keep_out_test {

constexpr double kRadius_m = 0.09;
constexpr Time kStart = Time{std::chrono::seconds(1)};

Trajectory candidate(const State& at, const Vec2& acceleration) {
  return accelerate_then_stop(kStart, at, acceleration, std::chrono::milliseconds(33), 5);
}

double least_distance(const Trajectory& trajectory, const Shape& zone) {
  double least = signed_distance(trajectory.rest_position_m(), zone);
  for (Time t = kStart; t < trajectory.end(); t += std::chrono::milliseconds(1))
    least = std::min(least, signed_distance(trajectory.state_at(t).position_m, zone));
  return least;
}

TEST_CASE("a robot outside a zone does not enter it, and a robot inside comes to rest no deeper in it") {
  const std::vector<Shape> zones{Circle{{0, 0}, 0.5}, ConvexPolygon{{{1, -1}, {2, -1}, {2, 1}, {1, 1}}},
                                 Circle{{0.3, 0.6}, 0.4}};
  int entered = 0, deeper = 0, allowed = 0;
  for (std::uint64_t seed = 1; seed <= 5000; ++seed) {
    Rng rng(seed);
    State at;
    at.position_m = {rng.uniform(-1, 2), rng.uniform(-1, 1)};
    at.velocity_mps = rotated({rng.uniform(0, 2), 0}, rng.uniform(0, 6.28));
    const Trajectory trajectory = candidate(at, rotated({rng.uniform(0, 3), 0}, rng.uniform(0, 6.28)));
    KeepOut keep_out;
    keep_out.find(zones, at.position_m, std::nullopt, {at.position_m, 3}, kRadius_m);
    const bool allows = keep_out.allows(trajectory);
    allowed += allows;
    CAPTURE(seed, at.position_m.transpose(), at.velocity_mps.transpose());
    bool is_good = true;
    double start_depth = 0;
    for (const Shape& zone : zones)
      start_depth = std::max(start_depth, kRadius_m - signed_distance(at.position_m, zone));
    for (const Shape& zone : zones) {
      const double from = signed_distance(at.position_m, zone);
      const double rest = signed_distance(trajectory.rest_position_m(), zone);
      if (from > kRadius_m) {
        const double least = least_distance(trajectory, zone);
        if (std::abs(least - kRadius_m) < 0.001)
          is_good = allows;  // within the path's accuracy, either result is accepted
        else if (least < kRadius_m)
          is_good = false;
        entered += least < kRadius_m;
      } else if (kRadius_m - rest > start_depth) {
        is_good = false;
        ++deeper;
      }
    }
    REQUIRE(allows == is_good);
  }
  CHECK(entered > 100);
  CHECK(deeper > 100);
  CHECK(allowed > 100);
}

TEST_CASE("a robot in overlapping zones may drive towards its way out") {
  const std::vector<Shape> zones{Circle{{-0.3, 0}, 0.4}, Circle{{0.3, 0}, 0.4}};
  const Trajectory up = candidate({{0, 0}, {0, 0}}, {0, 3}), left = candidate({{0, 0}, {0, 0}}, {-3, 0});
  const Vec2 start(0, 0), outside(0, 0.5);
  KeepOut keep_out;
  keep_out.find(zones, start, outside, {start, 1}, kRadius_m);
  CHECK(keep_out.allows(up));
  CHECK_FALSE(keep_out.allows(left));
  keep_out.find(zones, start, Vec2(-0.8, 0), {start, 1}, kRadius_m);
  CHECK(keep_out.allows(left));
}

}  // namespace sidestep::keep_out_test
