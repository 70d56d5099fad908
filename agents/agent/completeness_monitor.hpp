// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "agents/agent/obstacle_list_decoder.hpp"
#include "agents/agent/world_state_decoder.hpp"
#include "agents/safety/seen_region.hpp"

namespace sidestep {

/// Determines in which region, and at which time, the agent knew all obstacles that vision sees. Vision
/// states how far from the robots its list is complete; the world state of the same time says where this
/// robot was. So an incomplete list is usable only together with that world state. A list that never becomes
/// usable counts as lost.
class CompletenessMonitor {
 public:
  /// `max_speed_mps` is an upper bound of every obstacle's speed. `max_clock_difference` is an upper bound of
  /// the difference between the cameras' clock and the robot's.
  CompletenessMonitor(double max_speed_mps, Duration max_clock_difference)
      : max_speed_mps_(max_speed_mps), max_clock_difference_(max_clock_difference) {
    seen_.radius_m = 0;
  }

  void on_world_state(const WorldObservations& world);
  /// Precondition: all obstacles of the list were stored.
  void on_list(const ObstacleObservations& list);
  /// Records that obstacles outside the region `rest` were forgotten, and stay unknown until `until`.
  void on_forgotten(const SeenRegion& rest, Time until);

  /// The time of the latest usable list; Time{} if there is none.
  Time complete_at() const { return complete_at_; }
  /// The region in which all obstacles are known, for a robot that may lag by `max_lag` in excess of the
  /// clock bound.
  SeenRegion seen(Time now, Duration max_lag) const;

 private:
  /// A list that is not usable yet.
  struct Pending {
    Incarnation vision = 0;
    Time valid_at{};
    double complete_within_m = 0;
  };
  struct OwnPosition {
    Incarnation vision = 0;
    Time valid_at{};
    Vec2 position_m{0, 0};
  };
  /// Uses the pending list if its world state has arrived.
  void combine();

  double max_speed_mps_;
  Duration max_clock_difference_;
  std::array<OwnPosition, 16> positions_{};  // own positions in the world states of the last quarter second
  std::size_t position_count_ = 0;           // number of positions stored so far
  std::optional<Pending> pending_;
  SeenRegion seen_;
  Time complete_at_{};
  SeenRegion not_forgotten_;
  Time forgotten_until_{};
};

}  // namespace sidestep
