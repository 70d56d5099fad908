// SPDX-License-Identifier: Apache-2.0
// Point location in trapezoidal maps of random segments, compared with a search of all segments.
#include <algorithm>
#include <fmt/core.h>
#include <limits>

#include "agents/planning/grids/trapezoidal_map.hpp"
#include "tests/study/measurement/cpu_clock.hpp"
#include "tests/study/measurement/distribution.hpp"
#include "tests/unit/agents/planning/grids/random_segments.hpp"

using namespace sidestep;

namespace {

constexpr std::size_t kPoints = 1000, kRounds = 9;
constexpr std::int32_t kHalf = kMaxGridCoordinate / 2;
constexpr std::uint64_t kSeed = 1;

/// The height of the segment directly below a point, or of the bottom of the box.
double height_below(const std::vector<GridSegment>& segments, const GridPoint& point) {
  double height = -kMaxGridCoordinate;
  for (const GridSegment& segment : segments)
    if (segment.left <= point && point < segment.right && height_above(segment, point) >= 0)
      height = std::max(height, y_at(segment, point));
  return height;
}

double height_below(const TrapezoidalMap& map, const GridPoint& point) {
  const TrapezoidalMap::Trapezoid& trapezoid = map.trapezoids()[map.locate(point).trapezoid];
  return y_at(map.segments()[trapezoid.bottom], point);
}

/// The mean time of a search in nanoseconds, and the sum of its answers.
template <typename Searched>
double search_ns(const Searched& searched, const std::vector<GridPoint>& points, double& sum) {
  sum = 0;
  const double begin_us = cpu_us();
  for (const GridPoint& point : points) sum += height_below(searched, point);
  return 1e3 * (cpu_us() - begin_us) / static_cast<double>(points.size());
}

bool compare(std::size_t count) {
  Rng rng(kSeed);
  // Segment lengths are proportional to the spacing of the segments.
  const auto max_length = static_cast<std::int32_t>(kHalf / std::sqrt(static_cast<double>(count)));
  const std::vector<GridSegment> segments = random_divided_segments(rng, count, kHalf, max_length);
  std::vector<GridPoint> points;
  for (std::size_t i = 0; i < kPoints; ++i) points.push_back(random_grid_point(rng, kHalf));
  TrapezoidalMap map;
  Distribution build_us, map_ns, all_ns;
  std::size_t steps = 0;
  bool agrees = true;
  for (std::size_t round = 0; round < kRounds; ++round) {
    const double begin_us = cpu_us();
    map.build(segments, {kMaxGridCoordinate, kMaxGridCoordinate}, rng);
    build_us.add(cpu_us() - begin_us);
    double map_sum = 0, sum = 0;
    const bool is_map_first = rng.chance(0.5);
    if (is_map_first) map_ns.add(search_ns(map, points, map_sum));
    all_ns.add(search_ns(segments, points, sum));
    if (!is_map_first) map_ns.add(search_ns(map, points, map_sum));
    for (const GridPoint& point : points) {
      steps += map.locate(point).steps;
      agrees = agrees && height_below(map, point) == height_below(segments, point);
    }
    agrees = agrees && map_sum == sum;
  }
  fmt::print("{:>9}{:>13.0f}{:>13.1f}{:>14.1f}{:>18.0f}\n", segments.size(), build_us.median(),
             static_cast<double>(steps) / (kRounds * kPoints), map_ns.median(), all_ns.median());
  if (!agrees) fmt::print("a location is wrong\n");
  return agrees;
}

}  // namespace

int main() {
  fmt::print("Location of {} random points, medians of {} rounds, each in a newly built map.\n\n", kPoints,
             kRounds);
  fmt::print(" segments   build [us]  comparisons   locate [ns]   search all [ns]\n");
  bool agree = true;
  for (const std::size_t count : {64, 256, 1024, 4096, 16384}) agree = compare(count) && agree;
  return agree ? 0 : 1;
}
