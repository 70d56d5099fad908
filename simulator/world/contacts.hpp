// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/collision/shapes.hpp"
#include "common/map/floor_map.hpp"
#include "idl/monitor.hpp"
#include "simulator/world/body.hpp"

namespace sidestep {

/// `first` is the index of a body. `second` is the index of another body, or the number of bodies plus the
/// index of an obstacle. The map counts as one obstacle, after all others.
struct ContactPair {
  std::uint32_t first = 0, second = 0;
};

struct ContactTotals {
  std::uint64_t contacts = 0;  ///< number of times that a pair began to touch
  /// The latest contacts: contact k, counted from 0, is at k % MAX_CONTACTS.
  std::array<ContactPair, msg::MAX_CONTACTS> recent_contacts{};
  double penetration_m_s = 0;  ///< penetration depth integrated over time
  double min_clearance_m = 1;  ///< smallest distance between edges; distances above 1 m are not tracked
};

/// Detects, counts and resolves contacts of robots with each other and with obstacles. A pair is counted
/// again only after its clearance has exceeded kContactHysteresis_m. Bodies off the floor touch nothing.
/// Between two searches for neighbours, only pairs near enough to meet before the next search are checked.
class Contacts {
 public:
  /// `map` may be null.
  Contacts(std::span<const Shape> obstacles, std::shared_ptr<const FloorMap> map, double robot_radius_m,
           double speed_limit_mps);

  /// Checks the bodies after a physics step and separates those that touch, without restitution.
  void step(std::span<Body> bodies);

  /// Call when bodies have been lifted, put down or moved: the next step searches for near pairs again.
  void invalidate_near_pairs() { steps_to_next_search_ = 0; }

  const ContactTotals& totals() const { return totals_; }

  static constexpr double kContactHysteresis_m = 0.001;

 private:
  struct Pair {
    std::uint32_t first;
    std::uint32_t second;  ///< see ContactPair
    bool is_touching;
  };
  struct Overlap {
    std::uint32_t first, second;
    Vec2 normal;  ///< unit vector from the second body or obstacle to the first body
    double depth_m;
  };
  void find_near_pairs(std::span<const Body> bodies);
  void save_touching_pairs();
  void check_pair(Pair& pair, std::span<const Body> bodies);
  static void separate(const Overlap& overlap, std::span<Body> bodies);

  /// A disc that stands for the nearest part of an obstacle or body: a body touches the obstacle where its
  /// own disc touches this one. nullopt for an obstacle farther than `near_m`.
  std::optional<Circle> facing(const Vec2& position_m, std::size_t obstacle, double near_m) const;

  std::vector<Shape> obstacles_;
  std::shared_ptr<const FloorMap> map_;
  double radius_m_;
  double speed_limit_mps_;
  std::vector<Pair> near_pairs_;
  std::vector<Pair> touching_pairs_;
  std::vector<Overlap> overlaps_;
  std::vector<std::uint32_t> by_x_;
  int steps_to_next_search_ = 0;
  ContactTotals totals_;
};

}  // namespace sidestep
