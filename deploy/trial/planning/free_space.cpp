// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/planning/free_space.hpp"

#include <cmath>
#include <numbers>
#include <numeric>

namespace sidestep {
namespace {

/// The angle by which the direction from `centre` turns along the segment between two points.
double turn_rad(const Vec2& centre, const Vec2& from, const Vec2& to) {
  const Vec2 a = from - centre, b = to - centre;
  return std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
}

/// Union-find whose elements carry an angle relative to their set's representative.
class WindingSets {
 public:
  explicit WindingSets(std::size_t count) : parent_(count), angle_rad_(count, 0) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }

  /// Records that the angle of `b` exceeds that of `a` by `turn_rad`. Returns false if the difference already
  /// known disagrees by a full turn.
  [[nodiscard]] bool join(std::uint32_t a, std::uint32_t b, double turn_rad) {
    const std::uint32_t root_a = find(a), root_b = find(b);
    const double difference_rad = angle_rad_[a] + turn_rad - angle_rad_[b];
    if (root_a == root_b) return std::abs(difference_rad) < std::numbers::pi;
    parent_[root_b] = root_a;
    angle_rad_[root_b] = difference_rad;
    return true;
  }

 private:
  /// Returns the representative, and makes it the parent to shorten later searches.
  std::uint32_t find(std::uint32_t i) {
    const std::uint32_t parent = parent_[i];
    if (parent == i) return i;
    const std::uint32_t root = find(parent);
    if (parent != root) angle_rad_[i] += angle_rad_[parent];
    parent_[i] = root;
    return root;
  }

  std::vector<std::uint32_t> parent_;
  std::vector<double> angle_rad_;  // relative to the parent
};

}  // namespace

FreeSpace::FreeSpace(const PlanWorld& world) {
  for (const Shape& shape : world.obstacles) {
    blocked_.push_back(rounded(shape));
    blocked_.back().radius_m += world.radius_m;
  }
  add_field_sides(world);
  for (std::uint32_t j = 0; j < blocked_.size(); ++j) {
    for (std::uint32_t i = 0; i < j; ++i) {
      const RoundedShape &a = blocked_[i], &b = blocked_[j];
      const ClosestPoints closest = closest_points(a.corners_m, b.corners_m);
      const double reach_m = a.radius_m + b.radius_m;
      if (closest.distance_m > reach_m) continue;
      const double part = reach_m > 0 ? a.radius_m / reach_m : 0;
      overlaps_.push_back({i, j, closest.a_m + part * (closest.b_m - closest.a_m)});
    }
  }
}

/// Rectangles as thick as the field represent the half-planes: a curve outside the field winds around either
/// none or all of the positions in the field.
void FreeSpace::add_field_sides(const PlanWorld& world) {
  const Vec2 out(1.5 * world.field.length_m, 1.5 * world.field.width_m);
  const Vec2 in(world.field.length_m / 2 - world.radius_m, world.field.width_m / 2 - world.radius_m);
  for (const Box& side : {Box{{in.x(), -out.y()}, out}, Box{{-out.x(), in.y()}, out},
                          Box{-out, {-in.x(), out.y()}}, Box{-out, {out.x(), -in.y()}}})
    blocked_.push_back(rounded(side));
}

bool FreeSpace::connects(const Vec2& a, const Vec2& b) const {
  WindingSets sets(blocked_.size());
  for (const Overlap& overlap : overlaps_) {
    const Vec2& first = blocked_[overlap.first].corners_m[0];
    const Vec2& second = blocked_[overlap.second].corners_m[0];
    const auto turn = [&](const Vec2& centre) {
      return turn_rad(centre, first, overlap.common_m) + turn_rad(centre, overlap.common_m, second);
    };
    if (!sets.join(overlap.first, overlap.second, turn(a) - turn(b))) return false;
  }
  return true;
}

}  // namespace sidestep
