// SPDX-License-Identifier: Apache-2.0
// Benchmarks occupancy maps: compares the distance transform with
// OpenCV's exact one, which must give the same distances, and measures scans and queries, whose results are
// checked against slow references.
#include <algorithm>
#include <ctime>
#include <fmt/core.h>
#include <functional>
#include <numeric>
#include <opencv2/imgproc.hpp>

#include "common/map/distance_transform.hpp"
#include "common/map/floor_plan.hpp"
#include "common/map/laser_scanner.hpp"
#include "tests/unit/common/collision/random_world.hpp"

using namespace sidestep;

namespace {

constexpr int kRounds = 41, kScans = 1'000, kQueries = 20'000;
constexpr std::uint64_t kSeed = 1;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Processor time of this thread.
double now_us() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) * 1e6 + static_cast<double>(time.tv_nsec) * 1e-3;
}

double quantile(std::vector<double> values, double part) {
  const auto at = static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

/// Median times of the contestants over rounds in random order.
std::vector<double> medians_us(const std::vector<std::function<void()>>& contestants) {
  std::vector<std::vector<double>> times_us(contestants.size());
  std::vector<std::size_t> order(contestants.size());
  std::iota(order.begin(), order.end(), 0);
  Rng rng(kSeed);
  for (int round = 0; round < kRounds; ++round) {
    rng.shuffle(order);
    for (const std::size_t i : order) {
      const double begin_us = now_us();
      contestants[i]();
      times_us[i].push_back(now_us() - begin_us);
    }
  }
  std::vector<double> medians;
  for (const std::vector<double>& times : times_us) medians.push_back(quantile(times, 0.5));
  return medians;
}

/// An image of the map, 0 where a cell is blocked.
cv::Mat as_image(const OccupancyMap& map) {
  cv::Mat image(map.grid().rows, map.grid().columns, CV_8U);
  for (int row = 0; row < image.rows; ++row)
    for (int column = 0; column < image.cols; ++column)
      image.at<std::uint8_t>(row, column) = map.is_blocked({column, row}) ? 0 : 255;
  return image;
}

/// Counts cells whose distances differ from OpenCV's, which are rounded to single precision.
long count_different(const OccupancyMap& map, const cv::Mat& theirs) {
  long different = 0;
  distance_transform(map.blocked(), [&](int row, std::span<const std::int32_t> squared) {
    for (std::size_t x = 0; x < squared.size(); ++x) {
      const double their = theirs.at<float>(row, static_cast<int>(x));
      different += std::llround(their * their) != squared[x];
    }
  });
  return different;
}

bool bench_transform(const char* name, const OccupancyMap& map) {
  const cv::Mat image = as_image(map);
  cv::Mat theirs;
  const std::vector<double> times_us = medians_us({
      [&] { const DistanceField field(map); },
      [&] { cv::distanceTransform(image, theirs, cv::DIST_L2, cv::DIST_MASK_PRECISE); },
  });
  const long different = count_different(map, theirs);
  fmt::print("{:>6} x {:<6} {:<12}{:>9.2f} ms {:>12.2f} ms {:>9} cells differ\n", map.grid().columns,
             map.grid().rows, name, times_us[0] / 1e3, times_us[1] / 1e3, different);
  return different == 0;
}

/// A random position with at least this clearance.
Vec2 free_position(Rng& rng, const OccupancyMap& map, double clearance_m) {
  while (true) {
    const double x_m = rng.uniform(map.extent().min_m.x(), map.extent().max_m.x());
    const double y_m = rng.uniform(map.extent().min_m.y(), map.extent().max_m.y());
    if (map.distance_m({x_m, y_m}, 2 * clearance_m) > clearance_m) return {x_m, y_m};
  }
}

/// The distance along a ray to the first blocked cell, found in short steps: at most a step too far, unless
/// the ray only crosses a corner.
double marched_m(const OccupancyMap& map, const Vec2& from, const Vec2& direction, double max_m) {
  for (double at_m = 0; at_m <= max_m; at_m += 0.1 * map.grid().resolution_m)
    if (map.is_blocked(map.cell_at(from + at_m * direction))) return at_m;
  return kInfinite;
}

/// Counts the beams of a scan that differ from separately cast rays or from a march through the map.
long count_wrong(const LaserScanner& scanner, const RayScene& scene, const Vec2& at, double heading_rad,
                 const std::vector<float>& ranges_m) {
  long wrong = 0;
  const double max_m = scanner.settings().max_range_m;
  for (int beam = 0; beam < scanner.settings().beams; ++beam) {
    const double range_m = ranges_m[static_cast<std::size_t>(beam)];
    const double angle_rad = heading_rad + scanner.beam_angle_rad(beam);
    bool agrees = false;  // a ray that grazes an obstacle may miss it
    for (const double turn_rad : {0.0, -1e-7, 1e-7}) {
      const double ray_m = cast_ray(scene, at, rotated({1, 0}, angle_rad + turn_rad), max_m);
      agrees = agrees || range_m == ray_m || std::abs(range_m - ray_m) < 1e-3;
    }
    wrong += !agrees;
    if (scene.map != nullptr)
      wrong += range_m > marched_m(*scene.map, at, rotated({1, 0}, angle_rad), max_m) + 1e-3;
  }
  return wrong;
}

bool bench_scans(const char* name, const RayScene& scene, const std::vector<Vec2>& positions, double max_m) {
  const LaserScanner scanner({360, 2 * std::numbers::pi, 0, max_m});
  std::vector<float> ranges_m(360);
  std::vector<double> times_us;
  long wrong = 0, seen = 0;
  Rng rng(kSeed);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double heading_rad = rng.uniform(-3, 3);
    const double begin_us = now_us();
    scanner.scan(scene, positions[i], heading_rad, ranges_m);
    times_us.push_back(now_us() - begin_us);
    for (const float range_m : ranges_m) seen += std::isfinite(range_m);
    if (i % 20 == 0) wrong += count_wrong(scanner, scene, positions[i], heading_rad, ranges_m);
  }
  fmt::print("{:<48}{:>8.1f}{:>8.1f}{:>8.0f} %{:>8} wrong\n", name, quantile(times_us, 0.5),
             quantile(times_us, 0.99),
             100.0 * static_cast<double>(seen) / static_cast<double>(360 * times_us.size()), wrong);
  return wrong == 0;
}

bool bench_all_scans(const OccupancyMap& map, const DistanceField& field) {
  Rng rng(kSeed);
  std::vector<Circle> discs;
  std::vector<Vec2> positions, anywhere;
  for (int i = 0; i < 100; ++i) discs.push_back({free_position(rng, map, 0.3), 0.3});
  for (int i = 0; i < kScans; ++i) positions.push_back(free_position(rng, map, 0.3));
  for (int i = 0; i < kScans; ++i) anywhere.push_back(random_position(rng, 20));
  const ObstacleWorld shapes(random_shapes(rng, 100, 20));
  fmt::print("\nScans of 360 beams, µs                            median     p99     hits\n");
  bool is_right = bench_scans("map of 2,000 x 2,000 cells, 10 m", {&map, &field, nullptr, {}}, positions, 10);
  is_right &= bench_scans("the same map with 100 discs, 10 m", {&map, &field, nullptr, discs}, positions, 10);
  is_right &= bench_scans("the same map with 100 discs, 30 m", {&map, &field, nullptr, discs}, positions, 30);
  is_right &= bench_scans("100 shapes on 40 x 40 m, 10 m", {nullptr, nullptr, &shapes, {}}, anywhere, 10);
  is_right &= bench_scans("100 shapes on 40 x 40 m, 30 m", {nullptr, nullptr, &shapes, {}}, anywhere, 30);
  return is_right;
}

bool bench_queries(const OccupancyMap& map, const DistanceField& field) {
  Rng rng(kSeed);
  std::vector<Segment> paths;
  for (int i = 0; i < kQueries; ++i) {
    const Vec2 from = free_position(rng, map, 0.2);
    paths.push_back({from, from + random_displacement(rng, 2)});
  }
  long boxes = 0, touching = 0, touching_with_field = 0;
  double sum_m = 0, bounds_m = 0;
  const std::vector<double> times_us = medians_us({
      [&] {
        for (const Segment& path : paths) sum_m += map.distance_m(path.from_m, 1);
      },
      [&] {
        for (const Segment& path : paths) bounds_m += std::min(1.0, field.lower_bound_m(path.from_m));
      },
      [&] {
        for (const Segment& path : paths) touching += map.touches(path.from_m, path.to_m, 0.2);
      },
      [&] {
        for (const Segment& path : paths)
          touching_with_field += touches(map, field, path.from_m, path.to_m, 0.2);
      },
      [&] {
        for (const Segment& path : paths)
          map.for_each_box(inflated({path.from_m.cwiseMin(path.to_m), path.from_m.cwiseMax(path.to_m)}, 0.25),
                           [&](const Box&) { return ++boxes > 0; });
      },
  });
  const char* const names[] = {"distance up to 1 m", "lower bound of the field", "path of up to 2 m touches",
                               "path of up to 2 m touches, with the field", "boxes around the path"};
  fmt::print("\nQueries in the map of 2,000 x 2,000 cells, ns\n");
  for (std::size_t i = 0; i < times_us.size(); ++i)
    fmt::print("{:<42}{:>9.0f}\n", names[i], 1e3 * times_us[i] / kQueries);
  const double count = static_cast<double>(kRounds) * kQueries;
  fmt::print(
      "{:.1f} % of the paths touch, {:.1f} boxes around a path, mean distance {:.3f} m, bound {:.3f} m\n",
      100 * static_cast<double>(touching) / count, static_cast<double>(boxes) / count, sum_m / count,
      bounds_m / count);
  return touching == touching_with_field && bounds_m <= sum_m;
}

}  // namespace

int main() {
  cv::setNumThreads(1);
  fmt::print("Distance field of a map, medians of {} rounds   sidestep          OpenCV\n", kRounds);
  bool is_right = bench_transform("rooms", make_floor_plan(kSeed, {1'006, 1'674, 0.05, {0, 0}}));
  Rng rng(kSeed);
  BitGrid noise(1'006, 1'674), corner(1'006, 1'674);
  for (int row = 0; row < noise.rows(); ++row)
    for (int column = 0; column < noise.columns(); ++column)
      if (rng.chance(0.2)) noise.set(column, row);
  corner.set(0, 0);
  is_right &= bench_transform("20 % noise", OccupancyMap({1'006, 1'674, 0.05, {0, 0}}, noise));
  is_right &= bench_transform("one corner", OccupancyMap({1'006, 1'674, 0.05, {0, 0}}, corner));
  const OccupancyMap large = make_floor_plan(kSeed, {2'000, 2'000, 0.05, {0, 0}});
  is_right &= bench_transform("rooms", large);
  const DistanceField field(large);
  is_right &= bench_all_scans(large, field);
  is_right &= bench_queries(large, field);
  return is_right ? 0 : 1;
}
