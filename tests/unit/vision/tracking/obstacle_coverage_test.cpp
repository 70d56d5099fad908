// SPDX-License-Identifier: Apache-2.0
// Checks that obstacles stay within the discs in which agents expect them, even if they pass through each
// other and some frames miss them.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "common/messaging/detected_obstacles.hpp"
#include "common/protocol/obstacle_bounds.hpp"
#include "tests/catch.hpp"
#include "tests/unit/vision/tracker_fixture.hpp"

namespace sidestep::obstacle_coverage_test {

using namespace sidestep::test;

constexpr double kNoise_m = 0.0015;
constexpr double kMaxSpeed_mps = 1.5;
constexpr Duration kFrame{16'666'667};

/// Walks at constant speed between random places within one square metre.
struct Walker {
  double radius_m, speed_mps;
  Vec2 position_m, goal_m;

  void step(double dt_s, Rng& rng) {
    const Vec2 way = goal_m - position_m;
    const double step_m = speed_mps * dt_s;
    if (way.norm() <= step_m)
      goal_m = Vec2(rng.uniform(-0.5, 0.5), rng.uniform(-0.5, 0.5));
    else
      position_m += way.normalized() * step_m;
  }
};

/// The distance by which the walker protrudes from all discs in which agents expect obstacles.
double protrusion_m(const Walker& walker, const msg::ObstacleList& list) {
  double smallest_m = std::numeric_limits<double>::infinity();
  for (const msg::TrackedObstacle& track : list.obstacles()) {
    const double age_s = 1e-9 * static_cast<double>(list.valid_at_ns() - track.observed_at_ns());
    const double disc_m =
        track.radius_m() + kObstacleSigmas * std::sqrt(track.position_variance_m2()) + kMaxSpeed_mps * age_s;
    const Vec2 offset = walker.position_m - Vec2(track.x_m(), track.y_m());
    smallest_m = std::min(smallest_m, offset.norm() + walker.radius_m - disc_m);
  }
  return smallest_m;
}

std::vector<Walker> random_walkers(Rng& rng) {
  std::vector<Walker> walkers(5);
  for (Walker& walker : walkers) {
    walker.radius_m = rng.uniform(0.05, 0.3);
    walker.speed_mps = rng.uniform(0.2, 1) * kMaxSpeed_mps;
    walker.position_m = walker.goal_m = Vec2(rng.uniform(-0.5, 0.5), rng.uniform(-0.5, 0.5));
  }
  return walkers;
}

/// The largest protrusion of any walker in fifty seconds.
double max_protrusion_m(std::uint64_t seed, double miss_probability) {
  Rng rng(seed);
  std::vector<Walker> walkers = random_walkers(rng);
  ObstacleTracker tracker({.max_speed_mps = kMaxSpeed_mps, .position_noise_m = kNoise_m});
  Frame frame;
  msg::ObstacleList list;
  double largest_m = 0;
  for (int i = 0; i < 3000; ++i) {
    const Time t = kBegin + i * kFrame;
    const bool are_all_seen = i < 2;  // an obstacle is not listed before its second observation
    std::vector<Circle> seen;
    for (Walker& walker : walkers) {
      walker.step(to_seconds(kFrame), rng);
      if (!are_all_seen && rng.chance(miss_probability)) continue;
      const Vec2 error_m = kNoise_m * normal_vector(rng);
      seen.push_back({walker.position_m + error_m, walker.radius_m + kNoise_m * rng.normal()});
    }
    msg::DetectionFrame message = frame_message(0, t);
    set_obstacles(seen, message);
    frame.assign(message, t);
    tracker.update(frame);
    tracker.list_at(t, {}, list);
    if (i == 0) continue;
    for (const Walker& walker : walkers) largest_m = std::max(largest_m, protrusion_m(walker, list));
  }
  return largest_m;
}

TEST_CASE("obstacles that pass through each other stay within the discs in which agents expect them") {
  struct Case {
    double miss_probability, max_protrusion_m;
  };
  const Case test = GENERATE(Case{0, 0.005}, Case{0.1, 0.02});
  double largest_m = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(test.miss_probability, seed);
    largest_m = std::max(largest_m, max_protrusion_m(seed, test.miss_probability));
    REQUIRE(largest_m < test.max_protrusion_m);
  }
  WARN("missed with probability " << test.miss_probability << ", an obstacle protrudes by at most "
                                  << 1e3 * largest_m << " mm");
}

TEST_CASE("a track adopts the size of the latest observation immediately") {
  ObstacleTracker tracker({.max_speed_mps = kMaxSpeed_mps, .position_noise_m = kNoise_m});
  Frame frame;
  msg::ObstacleList list;
  Time t = kBegin;
  for (const double radius_m : {0.1, 0.1, 0.1, 0.3, 0.1, 0.2}) {
    CAPTURE(radius_m);
    std::vector<Circle> seen{{{0, 0}, radius_m}};
    msg::DetectionFrame message = frame_message(0, t += kFrame);
    set_obstacles(seen, message);
    frame.assign(message, t);
    tracker.update(frame);
    tracker.list_at(t, {}, list);
    if (t == kBegin + kFrame) continue;  // not confirmed yet
    REQUIRE(list.obstacles().size() == 1);
    CHECK(list.obstacles()[0].radius_m() >= radius_m);
    CHECK(list.obstacles()[0].radius_m() <= 0.3);
  }
}

}  // namespace sidestep::obstacle_coverage_test
