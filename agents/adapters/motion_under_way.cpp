// SPDX-License-Identifier: Apache-2.0
#include "agents/adapters/motion_under_way.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/messaging/version_codec.hpp"

namespace sidestep {
namespace {

using UnderWay = robot::MotionUnderWay<float>;

constexpr std::size_t kMaxParts = UnderWay::kMaxParts;
/// Maximum number of points of the path that are tried as ends of parts.
constexpr std::size_t kMaxTried = 30;
/// Weight of the squared deviation of velocities from their mean, in units of the squared duration. It
/// matters only where the path leaves the velocities undetermined.
constexpr double kRegularisation = 1e-8;
/// Rounding error of numbers in single precision.
constexpr double kRounding_m = 1e-6;

constexpr Duration kMinPart = std::chrono::milliseconds(2);
/// Maximum acceleration of a part. Receivers refuse higher accelerations, which they compute in single
/// precision.
constexpr double kMaxPartAcceleration_mps2 = 0.9 * kMaxAcceleration_mps2;

using Ends = std::array<std::size_t, kMaxParts + 1>;  ///< ends of the parts, as indices of points of the path
using Weights = Eigen::Matrix<double, static_cast<int>(kMaxParts) + 1, 1>;

/// Weights of the velocities at the ends of the parts; the displacement up to `point` is their weighted sum.
Weights weights_at(std::span<const PathPoint> path, const Ends& ends, std::size_t parts, std::size_t point) {
  Weights weights = Weights::Zero();
  for (std::size_t part = 0; part < parts && path[ends[part]].after < path[point].after; ++part) {
    const double begin_s = to_seconds(path[ends[part]].after);
    const double length_s = to_seconds(path[ends[part + 1]].after) - begin_s;
    const double s = std::min(to_seconds(path[point].after) - begin_s, length_s);
    const double later = s * s / (2 * length_s);
    weights[static_cast<int>(part)] += s - later;
    weights[static_cast<int>(part) + 1] += later;
  }
  return weights;
}

/// The velocities at the ends of the parts that fit the path best, by least squares; the last velocity is
/// given.
UnderWay fitted(std::span<const PathPoint> path, const Vec2& last_velocity_mps, const Ends& ends,
                std::size_t parts) {
  const int last = static_cast<int>(parts);
  const double total_s = to_seconds(path.back().after);
  const Vec2 mean_mps = (path.back().position_m - path.front().position_m) / total_s;
  Eigen::Matrix<double, kMaxParts, kMaxParts> normal =
      Eigen::Matrix<double, kMaxParts, kMaxParts>::Identity();
  normal *= kRegularisation * total_s * total_s;
  Eigen::Matrix<double, kMaxParts, 2> right = normal * Eigen::Vector3d::Ones() * mean_mps.transpose();
  for (std::size_t point = 1; point < path.size(); ++point) {
    const Weights weights = weights_at(path, ends, parts, point);
    const Vec2 moved_m = path[point].position_m - path.front().position_m - weights[last] * last_velocity_mps;
    Eigen::Vector3d free = weights.head<kMaxParts>();
    if (last < static_cast<int>(kMaxParts)) free[last] = 0;
    normal += free * free.transpose();
    right += free * moved_m.transpose();
  }
  const Eigen::Matrix<double, kMaxParts, 2> velocities = normal.ldlt().solve(right);
  const auto velocity = [&](std::size_t i) -> robot::Vec<float> {
    const Vec2 v = i == parts ? last_velocity_mps : Vec2(velocities.row(static_cast<int>(i)).transpose());
    return {static_cast<float>(v.x()), static_cast<float>(v.y())};
  };
  UnderWay motion;
  motion.from_mps = velocity(0);
  motion.part_count = static_cast<int>(parts);
  for (std::size_t part = 0; part < parts; ++part)
    motion.parts[part] = {(path[ends[part + 1]].after - path[ends[part]].after).count(), velocity(part + 1)};
  return motion;
}

/// Upper bound of the distance between the path and the motion. Between two points the path is straight with
/// constant velocity. With acceleration a and time t between the points, the motion deviates by at most a t²
/// / 8 from the straight line through its own positions.
double max_error_m(std::span<const PathPoint> path, const Ends& ends, const UnderWay& motion) {
  double largest_m = 0, error_m = 0;
  Vec2 place_m = path.front().position_m, velocity_mps(motion.from_mps.x, motion.from_mps.y);
  for (int part = 0; part < motion.part_count; ++part) {
    const std::size_t first = ends[static_cast<std::size_t>(part)],
                      end = ends[static_cast<std::size_t>(part) + 1];
    const Vec2 end_mps(motion.parts[part].end_velocity_mps.x, motion.parts[part].end_velocity_mps.y);
    const Vec2 acceleration_mps2 = (end_mps - velocity_mps) / to_seconds(path[end].after - path[first].after);
    for (std::size_t point = first + 1; point <= end; ++point) {
      const double s = to_seconds(path[point].after - path[first].after);
      const double step_s = to_seconds(path[point].after - path[point - 1].after);
      const Vec2 at_m = place_m + s * velocity_mps + 0.5 * s * s * acceleration_mps2;
      const double last_error_m = error_m;
      error_m = (at_m - path[point].position_m).norm();
      const double between_m = acceleration_mps2.norm() * step_s * step_s / 8;
      const double bound_m = std::max(error_m, last_error_m) + between_m;
      if (!std::isfinite(bound_m)) return bound_m;
      largest_m = std::max(largest_m, bound_m);
      if (point == end) place_m = at_m;
    }
    velocity_mps = end_mps;
  }
  return largest_m + kRounding_m;
}

bool are_long_enough(std::span<const PathPoint> path, const Ends& ends, std::size_t parts) {
  for (std::size_t part = 0; part < parts; ++part) {
    if (path[ends[part + 1]].after - path[ends[part]].after < kMinPart) return false;
  }
  return true;
}

/// False for a NaN.
bool are_accelerations_small(const UnderWay& motion) {
  Vec2 velocity_mps(motion.from_mps.x, motion.from_mps.y);
  for (int part = 0; part < motion.part_count; ++part) {
    const Vec2 end_mps(motion.parts[part].end_velocity_mps.x, motion.parts[part].end_velocity_mps.y);
    const double length_s = to_seconds(Duration{motion.parts[part].duration_ns});
    if (!((end_mps - velocity_mps).norm() <= kMaxPartAcceleration_mps2 * length_s)) return false;
    velocity_mps = end_mps;
  }
  return true;
}

/// A motion at the constant last velocity, for paths that are too short in time for a fit.
UnderWay constant(std::span<const PathPoint> path, const Vec2& velocity_mps) {
  UnderWay motion;
  motion.from_mps = {static_cast<float>(velocity_mps.x()), static_cast<float>(velocity_mps.y())};
  motion.part_count = 1;
  motion.parts[0] = {path.back().after.count(), motion.from_mps};
  motion.error_m = static_cast<float>(max_error_m(path, {0, path.size() - 1}, motion));
  return motion;
}

}  // namespace

robot::MotionUnderWay<float> fit_motion_under_way(std::span<const PathPoint> path,
                                                  const Vec2& last_velocity_mps) {
  UnderWay best;
  const std::size_t steps = path.empty() ? 0 : path.size() - 1;
  if (steps == 0) return best;
  best = constant(path, last_velocity_mps);
  const auto try_ends = [&](const Ends& ends, std::size_t parts) {
    if (!are_long_enough(path, ends, parts)) return;
    UnderWay motion = fitted(path, last_velocity_mps, ends, parts);
    motion.error_m = static_cast<float>(max_error_m(path, ends, motion));
    // A NaN does not count as better.
    if (motion.error_m < best.error_m && are_accelerations_small(motion)) best = motion;
  };
  const std::size_t stride = (steps + kMaxTried - 1) / kMaxTried;
  try_ends({0, steps}, 1);
  for (std::size_t first = 1; first < steps; first += stride) {
    try_ends({0, first, steps}, 2);
    for (std::size_t second = first + 1; second < steps; second += stride)
      try_ends({0, first, second, steps}, 3);
  }
  return best;
}

}  // namespace sidestep
