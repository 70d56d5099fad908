// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>

#include "common/protocol/robot_observation.hpp"
#include "coordinator/ledger.hpp"

namespace sidestep {

/// Finds robots that vision sees where none of their versions can have taken them: robots that coast without
/// power, robots that a person carries, and robots on the floor that count as absent. A robot is displaced
/// from the first such observation until kObservationsUntilBack consecutive observations agree with the
/// ledger again. A single observation may have an error. But a resting robot also counts as displaced if the
/// mean of its observations is away from its version: it may be unable to use observations itself, and would
/// stay in the wrong place forever.
class DisplacedRobots {
 public:
  static constexpr int kObservationsUntilBack = 3;
  static constexpr std::size_t kObservationsOfRest = 30;  // half a second at 60 Hz

  /// `margin_m` is the safety margin. Half of it covers the errors of a robot's tracking and of its clock.
  explicit DisplacedRobots(double margin_m) : margin_m_(margin_m) {}

  /// Compares an observation with the ledger. An observation that is older than the robot's last observation
  /// changes nothing. Returns whether the robot's last observation was compared; it is not if the ledger does
  /// not reach back to its time.
  bool observe(const RobotObservation& observation, const Ledger& ledger);
  bool contains(RobotId robot) const;
  bool any() const { return count_ > 0; }
  /// The last observation of a robot, displaced or not; nullopt if there is none yet. Its velocity is
  /// averaged over the last 15 cm, and is zero if the robot has moved by less than 1.5 cm.
  std::optional<RobotObservation> last_observation(RobotId robot) const;
  void clear();

 private:
  struct Track {
    static constexpr std::size_t kCapacity = 40;  // 0.7 s at 60 Hz
    std::array<RobotObservation, kCapacity> observations;
    std::size_t count = 0;
    bool is_compared = false;  // whether the last observation was compared
    bool is_displaced = false;
    int agreeing = 0;  // number of consecutive observations that agree with the ledger

    const RobotObservation& back(std::size_t age) const {
      return observations[(count - 1 - age) % kCapacity];
    }
    Vec2 mean_velocity_mps() const;
    /// The mean position over the last kObservationsOfRest observations.
    Vec2 mean_position_m() const;
  };
  /// Allowed distance of an observation from the version, beyond the version's inflation.
  double allowed_m(const RobotObservation& observation) const;
  /// Whether the robot should be at rest but the mean of its last observations is elsewhere.
  bool rests_elsewhere(const Track& track, const Ledger& ledger) const;

  double margin_m_;
  std::map<RobotId, Track> tracks_;
  std::size_t count_ = 0;  // number of displaced robots
};

}  // namespace sidestep
