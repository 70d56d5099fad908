// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/position_sampler.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace sidestep {
namespace {

constexpr int kMaxAttempts = 200;
constexpr double kExtraClearance_m = 0.01;
// On the straight line between two neighbouring cells, a robot comes nearer to an obstacle by at most half a
// cell.
constexpr double kFloorCell_m = 2 * kExtraClearance_m;

}  // namespace

PositionSampler::PositionSampler(const Scenario& scenario, Rng& rng) : scenario_(scenario), rng_(rng) {
  if (scenario.map || !scenario.obstacles.empty()) find_largest_part();
}

void PositionSampler::find_largest_part() {
  const Field& field = scenario_.field;
  grid_ = {static_cast<int>(std::ceil(field.length_m / kFloorCell_m)),
           static_cast<int>(std::ceil(field.width_m / kFloorCell_m)), kFloorCell_m,
           -0.5 * Vec2(field.length_m, field.width_m)};
  cv::Mat free(grid_.rows, grid_.columns, CV_8U), part_of, statistics, centroids;
  for (int row = 0; row < grid_.rows; ++row)
    for (int column = 0; column < grid_.columns; ++column)
      free.at<std::uint8_t>(row, column) =
          is_clear(Vec2(grid_.x_m(column), grid_.y_m(row)) + Vec2::Constant(kFloorCell_m / 2)) ? 1 : 0;
  const int parts = cv::connectedComponentsWithStats(free, part_of, statistics, centroids, 4, CV_32S);
  int largest = 0;  // the label of the cells that are not free
  for (int part = 1; part < parts; ++part)
    if (largest == 0 ||
        statistics.at<int>(part, cv::CC_STAT_AREA) > statistics.at<int>(largest, cv::CC_STAT_AREA))
      largest = part;
  largest_part_.emplace(grid_.columns, grid_.rows);
  for (int row = 0; largest != 0 && row < grid_.rows; ++row)
    for (int column = 0; column < grid_.columns; ++column)
      if (part_of.at<int>(row, column) == largest) largest_part_->set(column, row);
}

bool PositionSampler::is_free(const Vec2& p) const {
  const Cell cell = grid_.cell_at(p);
  return is_clear(p) && (!largest_part_ || (grid_.has(cell) && largest_part_->get(cell.column, cell.row)));
}

bool PositionSampler::is_clear(const Vec2& p) const {
  const double clearance_m = scenario_.radius_m + scenario_.margin_m + kExtraClearance_m;
  return scenario_.field.contains(p, clearance_m) &&
         std::ranges::none_of(
             scenario_.obstacles,
             [&](const Shape& obstacle) { return signed_distance(p, obstacle) < clearance_m; }) &&
         !(scenario_.map && scenario_.map->cells().touches(p, p, clearance_m));
}

bool PositionSampler::is_apart(const Vec2& p, const std::vector<Vec2>& others) const {
  const double separation_m = 2 * scenario_.radius_m + scenario_.margin_m + kExtraClearance_m;
  return std::ranges::none_of(others, [&](const Vec2& other) { return (p - other).norm() < separation_m; });
}

Vec2 PositionSampler::sample(double share) {
  for (int i = 0;; ++i) {
    const double part = i < kMaxAttempts ? share / 2 : 0.5;
    // y is sampled first, because the evaluation order of arguments would be unspecified.
    const double y = rng_.uniform(-part, part) * scenario_.field.width_m;
    const double x = rng_.uniform(-part, part) * scenario_.field.length_m;
    const Vec2 p(x, y);
    if (is_free(p)) return p;
  }
}

Vec2 PositionSampler::sample_apart(const std::vector<Vec2>& others) {
  for (;;) {
    const Vec2 p = sample();
    if (is_apart(p, others)) return p;
  }
}

Vec2 PositionSampler::sample_near(const Vec2& desired, const std::vector<Vec2>& others) {
  for (int i = 0; i < kMaxAttempts; ++i) {
    const double spread = 0.005 * i;
    const double y = rng_.uniform(-spread, spread), x = rng_.uniform(-spread, spread);
    const Vec2 p = desired + Vec2(x, y);
    if (is_free(p) && is_apart(p, others)) return p;
  }
  return sample_apart(others);
}

}  // namespace sidestep
