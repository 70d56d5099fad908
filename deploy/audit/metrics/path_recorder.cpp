// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/metrics/path_recorder.hpp"

#include <algorithm>
#include <utility>

namespace sidestep {
namespace {

constexpr double kTolerance_m = 0.01, kTolerance_mps = 0.05;

/// The larger of the deviations of a point from the even motion between two others, in multiples of the
/// tolerances.
double deviation(const PathRecorder::Point& from, const PathRecorder::Point& to,
                 const PathRecorder::Point& point, double tolerance_m, double tolerance_mps) {
  const double share = to_seconds(point.at - from.at) / to_seconds(to.at - from.at);
  const Vec2 expected_m = from.position_m + share * (to.position_m - from.position_m);
  const double expected_mps = from.speed_mps + share * (to.speed_mps - from.speed_mps);
  return std::max((point.position_m - expected_m).norm() / tolerance_m,
                  std::abs(point.speed_mps - expected_mps) / tolerance_mps);
}

}  // namespace

void PathRecorder::add(const Point& point) {
  if (const auto last = latest(); last && point.at <= last->at) return;
  if (!points_.empty() && point.at < points_.back().at + period_) {
    latest_ = point;
    return;
  }
  latest_.reset();
  points_.push_back(point);
  if (points_.size() <= max_points_) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points_.size(); i += 2) points_[kept++] = points_[i];
  // The last point is the latest one even if it is between two that are kept.
  if (points_.size() % 2 == 0) latest_ = points_.back();
  points_.resize(kept);
  period_ *= 2;
}

std::vector<PathRecorder::Point> PathRecorder::points() const {
  std::vector<Point> points = points_;
  if (latest_) points.push_back(*latest_);
  return simplified(points, kTolerance_m, kTolerance_mps);
}

std::vector<PathRecorder::Point> simplified(const std::vector<PathRecorder::Point>& points,
                                            double tolerance_m, double tolerance_mps) {
  if (points.size() < 3) return points;
  std::vector<bool> is_kept(points.size(), false);
  is_kept.front() = is_kept.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, points.size() - 1}};
  while (!open.empty()) {
    const auto [from, to] = open.back();
    open.pop_back();
    std::size_t farthest = from;
    double largest = 1;
    for (std::size_t i = from + 1; i < to; ++i) {
      const double here = deviation(points[from], points[to], points[i], tolerance_m, tolerance_mps);
      if (here > largest) {
        largest = here;
        farthest = i;
      }
    }
    if (farthest == from) continue;
    is_kept[farthest] = true;
    open.emplace_back(from, farthest);
    open.emplace_back(farthest, to);
  }
  std::vector<PathRecorder::Point> result;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (is_kept[i]) result.push_back(points[i]);
  return result;
}

}  // namespace sidestep
