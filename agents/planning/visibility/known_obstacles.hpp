// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/collision/shapes.hpp"

namespace sidestep {

/// Corners nearer than this to what they lie on lie on it: rounding.
inline constexpr double kTouching_m = 1e-9;

/// The obstacles that a search has run into, compared one by one: there are few of them, and what stopped one
/// way often stops the next.
class KnownObstacles {
 public:
  /// Forgets all, and keeps the memory. For a disc of the radius.
  void clear(double radius_m);
  /// The shape has to stay.
  void add(const Shape& shape);
  std::size_t size() const { return known_.size(); }

  /// Whether the one that stopped a motion the last time stops this one; all have to be asked otherwise.
  bool stop_again(const Segment& way) const;
  /// Whether any stops the motion.
  bool stop(const Segment& way);

  /// Whether a place lies in one of the obstacles from `first` to before `end`, or on its border.
  bool hold(const Vec2& place, std::size_t first, std::size_t end) const;

 private:
  struct Known {
    Box box;  // with the disc's radius
    const Shape* shape;
  };
  bool stops(const Known& known, const Segment& way, const Box& box) const;

  double radius_m_ = 0;
  std::vector<Known> known_;
  std::size_t last_ = 0;
};

}  // namespace sidestep
