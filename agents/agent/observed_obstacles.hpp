// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "agents/agent/world_view.hpp"
#include "agents/safety/moving_obstacle.hpp"

namespace sidestep {

/// The latest observations of obstacles that do not take part in the protocol. An observation is kept until a
/// newer one of the same track replaces it, because an occluded obstacle may still approach. It is dropped
/// after kMaxObservationAge, because a false track must not stop all robots: by then its reach covers half a
/// field, and about sixty frames of vision have not confirmed it.
class ObservedObstacles {
 public:
  static constexpr std::size_t kCapacity = std::size_t{2} * msg::MAX_OBSTACLES;
  static constexpr Duration kMaxObservationAge{1'000'000'000};

  /// `max_speed_mps`: upper bound of every obstacle's speed. `max_clock_difference`: upper bound of the
  /// difference between the cameras' clock and the robot's.
  ObservedObstacles(double max_speed_mps, Duration max_clock_difference)
      : max_speed_mps_(max_speed_mps), max_clock_difference_(max_clock_difference) {}

  /// Stores observations that may have been made by now. If the capacity is exceeded, the oldest observations
  /// are dropped.
  void on_world(const WorldObservations& world, Time now);
  /// The observations that are younger than kMaxObservationAge. Valid until the next call.
  std::span<const MovingObstacle> recent(Time now);
  /// Number of observations from the future.
  std::uint64_t invalid() const { return invalid_; }

 private:
  struct Track {
    std::uint64_t vision = 0;  // incarnation of the vision process that numbers the tracks
    std::uint32_t number = 0;
    bool operator==(const Track&) const = default;
  };
  void store(const Track& track, const MovingObstacle& obstacle);
  void drop(std::size_t index);

  double max_speed_mps_;
  Duration max_clock_difference_;
  std::array<Track, kCapacity> tracks_;
  std::array<MovingObstacle, kCapacity> obstacles_;
  std::size_t count_ = 0;
  std::uint64_t invalid_ = 0;
};

}  // namespace sidestep
