// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "common/geometry/vec2.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// Robots displaced by an operator, and robots those push in turn. Their contacts and positions say nothing
/// about the protocol. Robots are given by their index in the roster; times are the simulator's.
class Disturbances {
 public:
  /// Without position checks, a robot is assumed to be back in place after a timeout.
  Disturbances(std::size_t robots, bool has_position_checks);

  /// Ground truth reports that an operator disturbed the robot until `end_time`. Repetitions count once.
  void disturb(std::size_t robot, Time end_time, Time now);
  /// New ground truth: the positions of the robots that it contains. Robots farther apart than
  /// `contact_distance_m` do not touch.
  void update(Time now, const std::vector<std::optional<Vec2>>& positions_m, double contact_distance_m);
  /// A contact began; nullopt stands for anything but a robot. Returns whether a disturbed robot is involved.
  /// If only one of two robots is, the other one counts as disturbed for as long as they touch.
  bool on_contact(std::optional<std::size_t> first, std::optional<std::size_t> second);
  /// The robot was observed within its tracking bound.
  void confirm_in_place(std::size_t robot);

  bool is_disturbed(std::size_t robot) const { return states_[robot].until.has_value(); }

 private:
  struct State {
    std::optional<Time> reported_end;  ///< as last reported
    std::optional<Time> until;         ///< earliest time at which the robot can count as back in place
  };
  struct Push {
    std::size_t pushing, pushed;
  };
  void extend(std::size_t robot, Time end_time);

  bool has_position_checks_;
  Time now_{};
  std::vector<State> states_;
  std::vector<Push> pushes_;
};

}  // namespace sidestep
