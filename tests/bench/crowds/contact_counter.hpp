// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "common/collision/shapes.hpp"
#include "common/motion/trajectory.hpp"

namespace sidestep {

/// A robot's motion during one cycle: its state at the beginning, and a constant acceleration.
struct CycleMotion {
  State at_start;
  Vec2 acceleration_mps2{0, 0};
};

/// Counts how often two discs, or a disc and an obstacle, begin to touch. Samples the motion each
/// millisecond. As in the simulator, a pair that touches counts again only after it was a millimetre apart.
class ContactCounter {
 public:
  ContactCounter(double radius_m, std::vector<Shape> obstacles)
      : radius_m_(radius_m), obstacles_(std::move(obstacles)) {}

  /// Adds one cycle of all robots, which must be in the same order each time.
  void add(std::span<const CycleMotion> robots, double cycle_s);
  std::uint64_t contacts() const { return contacts_; }

 private:
  /// The index of a robot, and that of another robot, or the number of robots plus the index of an obstacle.
  using Pair = std::pair<std::size_t, std::size_t>;

  void check(const Pair& pair, double clearance_m);

  double radius_m_;
  std::vector<Shape> obstacles_;
  std::set<Pair> touching_;
  std::uint64_t contacts_ = 0;
};

}  // namespace sidestep
