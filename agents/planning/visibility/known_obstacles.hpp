// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/collision/shapes.hpp"

namespace sidestep {

/// A corner within this distance of a shape counts as lying on it.
inline constexpr double kCoincidence_m = 1e-9;

/// The obstacles that a search has encountered, tested one by one. They are few, and the obstacle that
/// blocked a motion often blocks the next motion.
class KnownObstacles {
 public:
  /// Removes all obstacles, keeping the allocated memory, and sets the radius of the moving disc.
  void clear(double radius_m);
  /// The shape must outlive this set.
  void add(const Shape& shape);
  std::size_t size() const { return known_.size(); }

  /// Whether the obstacle that blocked the last motion also blocks this motion. If false, use blocks().
  bool last_blocks(const Segment& motion) const;
  /// Whether any obstacle blocks the motion.
  bool blocks(const Segment& motion);

  /// Whether a position lies in, or on the border of, an obstacle with an index in [first, end).
  bool covers(const Vec2& position, std::size_t first, std::size_t end) const;

 private:
  struct Known {
    Box box;  // inflated by the disc's radius
    const Shape* shape = nullptr;
  };
  bool blocks_motion(const Known& known, const Segment& motion, const Box& box) const;

  double radius_m_ = 0;
  std::vector<Known> known_;
  std::size_t last_blocking_ = 0;
};

}  // namespace sidestep
