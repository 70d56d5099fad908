// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "agents/safety/moving_obstacle.hpp"
#include "idl/vision.h"

namespace sidestep {

/// What moves on the floor without asking, as vision last saw it. A sight stays until a newer one of the same
/// track replaces it: whatever was there may be hidden and still coming. After kForgottenAfter it is dropped
/// all the same. By then its reach covers half a floor, vision has seen the floor some sixty times without
/// it, and a track that was a mistake must not stop everybody.
class SeenObstacles {
 public:
  static constexpr std::size_t kMost = 2 * msg::MAX_OBSTACLES;
  static constexpr Duration kForgottenAfter{1'000'000'000};

  /// `speed_mps`: that nothing exceeds; `clocks_differ`: the cameras' clock and ours, at most.
  SeenObstacles(double speed_mps, Duration clocks_differ)
      : speed_mps_(speed_mps), clocks_differ_(clocks_differ) {}

  /// Takes what makes sense; when there is no room left, the oldest sight goes.
  void on_world(const msg::WorldState& world, Time now);
  /// What has been seen lately. Valid until the next call.
  std::span<const MovingObstacle> recent(Time now);
  std::uint64_t invalid() const { return invalid_; }

 private:
  struct Track {
    std::uint64_t vision = 0;  // which life of it counts the tracks
    std::uint32_t number = 0;
    bool operator==(const Track&) const = default;
  };
  void put(const Track& track, const MovingObstacle& seen);
  void drop(std::size_t index);

  double speed_mps_;
  Duration clocks_differ_;
  std::array<Track, kMost> tracks_;
  std::array<MovingObstacle, kMost> seen_;
  std::size_t count_ = 0;
  std::uint64_t invalid_ = 0;
};

}  // namespace sidestep
