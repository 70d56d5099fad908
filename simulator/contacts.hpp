// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/geometry/circle.hpp"
#include "idl/monitor.h"
#include "simulator/body.hpp"

namespace sidestep {

/// A body's index, and another one's, or the number of bodies + an obstacle's.
struct Touch {
  std::uint32_t first = 0, second = 0;
};

struct ContactTotals {
  std::uint64_t contacts = 0;                     ///< pairs that began to touch
  std::array<Touch, msg::MAX_TOUCHES> touches{};  ///< the last of them: the k-th, from 0, at k % MAX_TOUCHES
  double penetration_m_s = 0;                     ///< interpenetration depth x time
  double min_clearance_m = 1;  ///< smallest distance between edges; what is farther than 1 m is not looked at
};

/// Finds, counts and separates robots that touch each other or an obstacle. Counts a pair again only after it
/// was apart by kApart_m. Bodies off the floor touch nothing. Pairs that cannot meet before the next look at
/// all of them are left out.
class Contacts {
 public:
  Contacts(std::span<const Circle> obstacles, double robot_radius_m, double speed_limit_mps);

  /// Looks at where the bodies are after a physics step, and pushes apart those that touch, without any
  /// bounce.
  void step(std::span<Body> bodies);

  /// Bodies have come, gone or been moved: whatever was near whom, it is looked for again.
  void search_again() { steps_to_next_search_ = 0; }

  const ContactTotals& totals() const { return totals_; }

  static constexpr double kApart_m = 0.001;

 private:
  struct Pair {
    std::uint32_t first;
    std::uint32_t second;  ///< a body's index, or the number of bodies + an obstacle's
    bool is_touching;
  };
  struct Overlap {
    std::uint32_t first, second;
    Vec2 away;  ///< from the second to the first, of length 1
    double depth_m;
  };
  void find_near(std::span<const Body> bodies);
  void remember_touching();
  void look_at(Pair& pair, std::span<const Body> bodies);
  static void separate(const Overlap& overlap, std::span<Body> bodies);

  std::vector<Circle> obstacles_;
  double radius_m_;
  double speed_limit_mps_;
  std::vector<Pair> near_;
  std::vector<Pair> touching_;
  std::vector<Overlap> overlaps_;
  std::vector<std::uint32_t> by_x_;
  int steps_to_next_search_ = 0;
  ContactTotals totals_;
};

}  // namespace sidestep
