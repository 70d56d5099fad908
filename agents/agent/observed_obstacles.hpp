// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "agents/agent/completeness_monitor.hpp"
#include "agents/safety/moving_obstacle.hpp"

namespace sidestep {

/// The latest observations of obstacles that do not take part in the protocol, and the region in which they
/// are all there are. An observation is kept until a newer one of the same track replaces it, because an
/// occluded obstacle may still approach. It is dropped after kMaxObservationAge, because a false track must
/// not stop all robots: by then its reach covers half a field, and about sixty frames of vision have not
/// confirmed it. Allocates only in the constructor.
class ObservedObstacles {
 public:
  static constexpr std::size_t kCapacity = std::size_t{2} * msg::MAX_OBSTACLES;
  static constexpr Duration kMaxObservationAge{1'000'000'000};

  /// `max_speed_mps`: upper bound of every obstacle's speed. `max_clock_difference`: upper bound of the
  /// difference between the cameras' clock and the robot's.
  ObservedObstacles(double max_speed_mps, Duration max_clock_difference);

  void on_world(const WorldObservations& world) { completeness_.on_world(world); }
  /// Stores observations that may have been made by now. If the capacity is exceeded, forgets the obstacles
  /// that are farthest from the robot. `robot_m`: its position.
  void on_list(const ObstacleObservations& list, const Vec2& robot_m, Time now);
  /// The observations that are younger than kMaxObservationAge. Valid until the next call.
  std::span<const MovingObstacle> recent(Time now);
  /// Where there are no obstacles but the recent ones.
  SeenRegion seen(Time now) const { return completeness_.seen(now); }
  /// The time for which this is known; Time{}: for none.
  Time complete_at() const { return completeness_.complete_at(); }
  /// Number of lists and observations from the future.
  std::uint64_t invalid() const { return invalid_; }

 private:
  struct Track {
    std::uint64_t vision = 0;  // incarnation of the vision process that numbers the tracks
    std::uint32_t number = 0;
    auto operator<=>(const Track&) const = default;
  };
  void store(const Track& track, const MovingObstacle& obstacle, const Vec2& robot_m, Time now);
  /// Forgets the farthest obstacle, unless it is nearer than this one. Returns whether it has.
  bool make_room_for(const MovingObstacle& obstacle, const Vec2& robot_m, Time now);
  void drop_old(Time now);
  /// Whether something is remembered that was accepted when the robot's clock was ahead of now.
  bool has_future(Time now) const;
  /// Forgets everything. Lists count again when every forgotten obstacle would have been dropped.
  void forget(Time now);

  double max_speed_mps_;
  Duration max_clock_difference_;
  CompletenessMonitor completeness_;
  std::vector<Track> tracks_;              // ascending
  std::vector<MovingObstacle> obstacles_;  // of tracks_
  std::uint64_t invalid_ = 0;
  Time incomplete_until_{};  // after forget()
};

}  // namespace sidestep
