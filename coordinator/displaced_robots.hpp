// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>

#include "common/protocol/robot_observation.hpp"
#include "coordinator/ledger.hpp"

namespace sidestep {

/// The robots that vision sees where none of their versions can have taken them: robots without power that
/// roll on, robots that somebody carries, and robots on the floor that count as absent. A robot is displaced
/// from the first such observation until kObservationsUntilBack consecutive ones agree with the ledger again.
/// Single observations are allowed an error. The mean of those of a resting robot is not, because such a
/// robot could stay where it is for ever: it may be unable to use observations itself.
class DisplacedRobots {
 public:
  static constexpr int kObservationsUntilBack = 3;
  static constexpr std::size_t kObservationsOfRest = 30;  // half a second at 60 Hz

  /// `margin_m`: the safety margin. Half of it covers a robot's tracking error and its clock.
  explicit DisplacedRobots(double margin_m) : margin_m_(margin_m) {}

  /// Compares an observation with the ledger. Older observations than the robot's last one change nothing.
  /// Returns whether the robot's last observation was compared: false if the ledger does not reach back so
  /// far.
  bool observe(const RobotObservation& observation, const Ledger& ledger);
  bool contains(RobotId robot) const;
  bool any() const { return count_ > 0; }
  /// The last observation of a robot, displaced or not; nullopt: none yet. Its velocity is the mean one over
  /// the last 15 cm, and zero if the robot has moved by less than 1.5 cm.
  std::optional<RobotObservation> last_observation(RobotId robot) const;
  void clear();

 private:
  struct Track {
    static constexpr std::size_t kCapacity = 40;  // 0.7 s at 60 Hz
    std::array<RobotObservation, kCapacity> observations;
    std::size_t count = 0;
    bool is_compared = false;  // the last one
    bool is_displaced = false;
    int agreeing = 0;  // consecutive observations that agree with the ledger

    const RobotObservation& back(std::size_t age) const {
      return observations[(count - 1 - age) % kCapacity];
    }
    Vec2 mean_velocity_mps() const;
    /// Of the last kObservationsOfRest observations.
    Vec2 mean_position_m() const;
  };
  /// Distance from the version that is allowed beyond its inflation.
  double allowed_m(const RobotObservation& observation) const;
  /// Whether the robot should rest, and the mean of its last observations is elsewhere.
  bool rests_elsewhere(const Track& track, const Ledger& ledger) const;

  double margin_m_;
  std::map<RobotId, Track> tracks_;
  std::size_t count_ = 0;  // of displaced robots
};

}  // namespace sidestep
