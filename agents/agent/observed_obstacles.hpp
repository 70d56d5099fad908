// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "agents/agent/completeness_monitor.hpp"
#include "agents/safety/moving_obstacle.hpp"

namespace sidestep {

/// The latest observations of obstacles that do not take part in the protocol, and the region for which they
/// are complete. An observation is kept until a newer observation of its track replaces it, because an
/// occluded obstacle may still approach. It is dropped after kMaxObservationAge, because a false track must
/// not stop all robots: by then the obstacle could be anywhere on half of the field, and about sixty frames
/// of vision have not confirmed it. Allocates only in the constructor.
class ObservedObstacles {
 public:
  static constexpr std::size_t kCapacity = std::size_t{2} * msg::MAX_OBSTACLES;
  static constexpr Duration kMaxObservationAge{1'000'000'000};

  /// `max_speed_mps` is an upper bound of every obstacle's speed. `max_clock_difference` is an upper bound of
  /// the difference between the cameras' clock and the robot's.
  ObservedObstacles(double max_speed_mps, Duration max_clock_difference);

  void on_world_state(const WorldObservations& world) { completeness_.on_world_state(world); }
  /// Stores observations whose times are not in the future. If the capacity is exceeded, forgets the
  /// obstacles that are farthest from the robot. `robot_m` is the robot's position.
  void on_list(const ObstacleObservations& list, const Vec2& robot_m, Time now);
  /// The observations that are younger than kMaxObservationAge, for a robot that may lag by `max_lag` in
  /// excess of the clock bound. Valid until the next call.
  std::span<const MovingObstacle> recent(Time now, Duration max_lag);
  /// The region in which there are no obstacles except the recent obstacles.
  SeenRegion seen(Time now, Duration max_lag) const { return completeness_.seen(now, max_lag); }
  /// The latest time at which the agent knew the region that seen() describes; Time{} if never.
  Time complete_at() const { return completeness_.complete_at(); }
  /// Number of lists and observations with times in the future.
  std::uint64_t invalid() const { return invalid_; }

 private:
  struct Track {
    std::uint64_t vision = 0;  // incarnation of the vision process that numbers the tracks
    std::uint32_t number = 0;
    auto operator<=>(const Track&) const = default;
  };
  void store(const Track& track, const MovingObstacle& obstacle, const Vec2& robot_m, Time now);
  /// Forgets the farthest stored obstacle if it is farther away than `obstacle`. Returns whether it forgot an
  /// obstacle.
  bool make_room_for(const MovingObstacle& obstacle, const Vec2& robot_m, Time now);
  void drop_old(Time now);
  /// Whether any stored observation is later than `now`, because it was accepted when the robot's clock was
  /// ahead.
  bool has_future(Time now) const;
  /// Forgets everything. Lists are used again only once every forgotten obstacle would have been dropped
  /// anyway.
  void forget(Time now);

  double max_speed_mps_;
  Duration max_clock_difference_;
  CompletenessMonitor completeness_;
  std::vector<Track> tracks_;              // sorted by track number
  std::vector<MovingObstacle> obstacles_;  // the obstacles in tracks_
  std::vector<MovingObstacle> recent_;     // result of recent() for a robot that may lag
  std::uint64_t invalid_ = 0;
  Time incomplete_until_{};  // set by forget()
};

}  // namespace sidestep
