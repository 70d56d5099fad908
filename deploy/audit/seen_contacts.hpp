// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/geometry/vec2.hpp"
#include "deploy/audit/audit_shape.hpp"

namespace sidestep {

/// The latest observation of one robot by vision.
struct VisionSighting {
  std::int64_t observed_at_ns = std::numeric_limits<std::int64_t>::min();
  Vec2 position_m{0, 0};
  Vec2 velocity_mps{0, 0};
  bool is_new = false;  ///< observed since the previous world state
};

/// A contact seen by vision between a robot and another robot or an obstacle.
struct SeenContact {
  std::size_t first = 0;              ///< index in the roster
  std::optional<std::size_t> second;  ///< nullopt: the contact is with an obstacle
  double distance_m = 0;              ///< between the centres, or from the centre to the obstacle's edge
  /// Time at which the pair was last seen apart; the lowest number if it never was.
  std::int64_t apart_ns = std::numeric_limits<std::int64_t>::min();
};

/// Finds contacts in vision's observations: robots whose distance is below the sum of their radii. The
/// protocol keeps robots apart by at least the margin minus both tracking bounds. If observation errors may
/// exceed that, the threshold is lower by the excess, so that robots that obey the protocol are never
/// reported as touching.
class SeenContacts {
 public:
  explicit SeenContacts(const Scenario& scenario);

  /// Processes the robots in a new world state. Returns the contacts that began; each is returned once it has
  /// been observed twice.
  [[nodiscard]] std::vector<SeenContact> update(const std::vector<VisionSighting>& sights);
  /// Call if world states were missed: earlier observations then do not confirm later ones.
  void on_missed();

 private:
  using Pair = std::pair<std::size_t, std::size_t>;  ///< second: index of a robot, or number of robots +
                                                     ///< index of an obstacle; the map is the last obstacle

  /// Processes one observation of a pair. Returns whether a contact begins.
  bool observe(const Pair& pair, double distance_m, double contact_distance_m, double allowance_m,
               std::int64_t at_ns);
  std::int64_t& apart_ns(const Pair& pair) { return apart_ns_[pair.first * seen_ + pair.second]; }
  double robot_allowance_m(double time_difference_s) const;

  double radius_m_;
  /// Distance from the nearest blocked cell of the map; infinite if none is near enough to matter.
  double distance_from_map_m(const Vec2& position_m) const;

  std::vector<AuditShape> obstacles_;
  std::shared_ptr<const FloorMap> map_;
  double position_error_m_;
  double acceleration_mps2_;
  double guaranteed_m_, guaranteed_to_obstacle_m_;
  std::map<Pair, int> observations_;  ///< number of observations of each pair in contact
  std::size_t seen_ = 0;  ///< number of objects that can be touched: robots, obstacles and the map
  std::vector<std::int64_t> apart_ns_;  ///< indexed by robot, then by the object that may touch it
};

/// Upper bound of the error of an observed position on each axis.
[[nodiscard]] double position_error_m(const VisionSpec& vision);

}  // namespace sidestep
