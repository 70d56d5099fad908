// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "common/geometry/vec2.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// Records where a robot was, in bounded memory: a full recorder forgets every second point and from then on
/// records half as often.
class PathRecorder {
 public:
  struct Point {
    Time at{};
    Vec2 position_m{0, 0};
    double speed_mps = 0;
  };
  static constexpr Duration kFirstPeriod = std::chrono::milliseconds(50);

  explicit PathRecorder(std::size_t max_points) : max_points_(max_points) {}

  /// Ignores points that are not later than the last one.
  void add(const Point& point);
  /// The recorded points, and the latest one. Points that lie within 1 cm and 0.05 m/s of the even motion
  /// between their neighbours are left out.
  std::vector<Point> points() const;
  /// The latest point; nullopt if there is none.
  std::optional<Point> latest() const {
    return latest_ || points_.empty() ? latest_ : std::optional(points_.back());
  }

 private:
  std::size_t max_points_;
  Duration period_ = kFirstPeriod;
  std::vector<Point> points_;
  std::optional<Point> latest_;  ///< if it is later than the last recorded point
};

/// Leaves out points that lie within the tolerances of the even motion between the remaining ones (Douglas
/// and Peucker, with distances at the same time).
[[nodiscard]] std::vector<PathRecorder::Point> simplified(const std::vector<PathRecorder::Point>& points,
                                                          double tolerance_m, double tolerance_mps);

}  // namespace sidestep
