// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "common/protocol/drop_counters.hpp"
#include "common/protocol/robot_messages.hpp"
#include "idl/vision.hpp"

namespace sidestep {

/// The part of a world state that the agent of one robot uses. All numbers are finite, but the times may be
/// arbitrary.
struct WorldObservations {
  Incarnation vision = 0;  ///< incarnation of the vision process
  Time valid_at{};
  std::optional<PoseFix> self{};        ///< last observation of the robot itself
  Vec2 self_m{0, 0};                    ///< predicted position of the robot at valid_at
  bool is_self_seen_elsewhere = false;  ///< later observations agree on another place
};

/// Decodes untrusted world states for the agent of one robot. Other robots' entries are not decoded, because
/// there may be a thousand of them. Allocates nothing.
class WorldStateDecoder {
 public:
  explicit WorldStateDecoder(RobotId robot) : robot_(robot) {}

  /// Decodes a world state. Omits and counts an invalid observation.
  [[nodiscard]] WorldObservations decode(const msg::WorldState& message);
  std::uint64_t invalid() const { return invalid_; }
  void count_drops(DropCounters& drops) const {
    drops.count(DropReason::kMalformedObservation, std::nullopt, invalid_);
  }

 private:
  /// The robot's entry, or nullptr.
  const msg::TrackedRobot* find_self(const msg::WorldState& message);

  RobotId robot_;
  std::size_t index_ = 0;      // index of the robot in the last world state that contained it
  std::uint64_t invalid_ = 0;  ///< number of invalid observations of the robot
};

}  // namespace sidestep
