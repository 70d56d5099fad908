// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include "agents/navigation/bubble_band/bubble_band.hpp"
#include "common/geometry/segment.hpp"
#include "tests/bench/local_methods/measurement.hpp"
#include "tests/bench/local_methods/scenes.hpp"
#include "tests/study/measurement/cpu_clock.hpp"

namespace sidestep {
namespace {

/// The baseline for ObstaclePoints: a plain loop in double precision.
struct PlainPoints {
  std::vector<Vec2> points_m;
  FreeDistance operator()(const Vec2& at_m, double) const {
    double least2 = 1e18;
    Vec2 nearest(0, 0);
    for (const Vec2& point : points_m) {
      const double distance2 = (point - at_m).squaredNorm();
      if (distance2 < least2) {
        least2 = distance2;
        nearest = point;
      }
    }
    return {std::sqrt(least2), (at_m - nearest).normalized()};
  }
};

/// A robot that follows a winding corridor with its band.
struct BandRun {
  static constexpr double kRadius_m = 0.3, kAdvance_m = 0.003;
  PlainPoints plain;
  BubbleBand band{kRadius_m}, plain_band{kRadius_m};
  Vec2 robot_m{0, 0};

  explicit BandRun(Rng& rng) {
    const Corridor corridor = Corridor::random(rng, kRadius_m, 9.5);
    plain.points_m = corridor.wall_points(kBeams);
    band.start(corridor.path(), plain);
    plain_band.start(corridor.path(), plain);
    robot_m = corridor.middle_m(0);
  }
};

/// Whether the robot can follow the whole band, checked against every point.
bool is_free(const BandRun& run) {
  const auto bubbles = run.band.bubbles();
  for (std::size_t i = 1; i < bubbles.size(); ++i) {
    const Segment leg{bubbles[i - 1].centre_m, bubbles[i].centre_m};
    for (const Vec2& point : run.plain.points_m) {
      if (squared_distance(point, leg) < BandRun::kRadius_m * BandRun::kRadius_m - 1e-5) return false;
    }
  }
  return !run.band.is_broken();
}

/// Whether vectors and the plain loop measure the same distances at all bubbles.
bool agrees(const ObstaclePoints& points, const BandRun& run) {
  for (const Bubble& bubble : run.band.bubbles()) {
    const double difference_m =
        points(bubble.centre_m, 0).distance_m - run.plain(bubble.centre_m, 0).distance_m;
    if (std::abs(difference_m) > 1e-5) return false;
  }
  return true;
}

}  // namespace

bool compare_bands() {
  constexpr std::size_t kUpdates = 60;
  Rng rng(kBenchSeed);
  std::vector<BandRun> runs;
  while (runs.size() < kBenchScenes / kUpdates) runs.emplace_back(rng);
  ObstaclePoints points;
  Distribution times_us, plain_us, bubbles;
  std::size_t wrong = 0;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < runs.size() * kUpdates; ++i) order.push_back(i % runs.size());
  rng.shuffle(order);
  for (const std::size_t which : order) {
    BandRun& run = runs[which];
    run.robot_m = run.band.position_m(BandRun::kAdvance_m);
    const bool is_first = rng.chance(0.5);
    const auto update_plain = [&] {
      const double begin_us = cpu_us();
      run.plain_band.update(run.robot_m, run.plain);
      plain_us.add(cpu_us() - begin_us);
    };
    if (is_first) update_plain();
    const double begin_us = cpu_us();
    points.set(run.plain.points_m, run.robot_m);
    run.band.update(run.robot_m, points);
    times_us.add(cpu_us() - begin_us);
    if (!is_first) update_plain();
    bubbles.add(static_cast<double>(run.band.bubbles().size()));
    if (!is_free(run) || !agrees(points, run)) ++wrong;
  }
  print_header("Bubble band in a winding corridor, 360 points; result: mean number of bubbles");
  print_row("update, points in vectors", times_us, bubbles.mean());
  print_row("update, plain loop", plain_us, bubbles.mean());
  if (wrong > 0)
    fmt::print("WRONG: {} updates gave a band that is not free, or differs from the plain one\n", wrong);
  return wrong == 0;
}

}  // namespace sidestep
