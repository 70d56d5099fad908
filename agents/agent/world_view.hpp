// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "common/protocol/robot_messages.hpp"
#include "idl/vision.hpp"

namespace sidestep {

/// An opponent or a person, as vision last observed it.
struct ObservedObstacle {
  std::uint32_t track = 0;  ///< numbered by the vision process, never reused
  Time observed_at{};
  Vec2 position_m{0, 0};
  double radius_m = 0;
  double position_variance_m2 = 0;  ///< per axis
};

/// The part of a world state that the agent of one robot uses. All numbers are finite, but the times may be
/// arbitrary.
struct WorldObservations {
  Incarnation vision = 0;         ///< of the vision process
  std::optional<PoseFix> self{};  ///< last observation of the robot itself
  std::size_t obstacle_count = 0;
  /// Only the first obstacle_count are used.
  std::array<ObservedObstacle, msg::MAX_OBSTACLES> obstacles{};
};

/// Decodes untrusted world states for the agent of one robot. Other robots in the world are not decoded,
/// because there may be a thousand of them. Allocates nothing.
class WorldView {
 public:
  explicit WorldView(RobotId robot) : robot_(robot) {}

  /// Leaves out invalid observations, and counts them.
  [[nodiscard]] WorldObservations decode(const msg::WorldState& message);
  std::uint64_t invalid() const { return invalid_; }

 private:
  /// The robot's entry, or nullptr.
  const msg::TrackedRobot* find_self(const msg::WorldState& message);
  void decode_obstacles(const msg::WorldState& message, WorldObservations& world);

  RobotId robot_;
  std::size_t index_ = 0;  // of the robot in the last world that contained it
  std::uint64_t invalid_ = 0;
};

}  // namespace sidestep
