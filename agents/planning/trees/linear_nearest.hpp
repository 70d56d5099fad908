// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sidestep {

/// Nearest neighbours by linear search, with the interface of KdTree.
template <std::size_t N>
class LinearNearest {
 public:
  using Point = std::array<double, N>;

  void clear() { points_.clear(); }
  std::size_t size() const { return points_.size(); }
  void add(const Point& point) { points_.push_back(point); }

  /// Index of the nearest point. Requires a non-empty set.
  std::uint32_t nearest(const Point& point) const {
    std::uint32_t best = 0;
    double best_distance2 = distance2(points_[0], point);
    for (std::size_t i = 1; i < points_.size(); ++i) {
      const double d2 = distance2(points_[i], point);
      if (d2 >= best_distance2) continue;
      best_distance2 = d2;
      best = static_cast<std::uint32_t>(i);
    }
    return best;
  }

 private:
  static double distance2(const Point& a, const Point& b) {
    double sum = 0;
    for (std::size_t axis = 0; axis < N; ++axis) sum += (a[axis] - b[axis]) * (a[axis] - b[axis]);
    return sum;
  }
  std::vector<Point> points_;
};

}  // namespace sidestep
