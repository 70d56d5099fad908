// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/league/control_packet.hpp"
#include "common/league/vision_packet.hpp"

namespace sidestep {

/// Brings the robots and the ball of a simulator of the league to where a scenario wants them. It looks where
/// vision sees robots, removes those that are in a wrong place or not in the scenario, places the scenario's,
/// and looks again, until vision agrees. Robots are removed first, because one that is placed where another
/// stands touches it. A scenario without a ball leaves the ball where it is.
class LeaguePlacement {
 public:
  /// How long frames are collected before they are judged, and the time after a command in which frames may
  /// still show the floor before it.
  static constexpr Duration kLook{500'000'000}, kReaction{300'000'000};

  /// Throws std::invalid_argument if two robots of the scenario have the same team and number.
  explicit LeaguePlacement(const Scenario& scenario);

  void on_frame(const league::DetectionFrame& frame, Time now);
  void on_answer(const league::SimulatorResponse& answer);
  /// The command to send now; nullopt: none. Must be called often.
  [[nodiscard]] std::optional<league::SimulatorCommand> update(Time now);
  /// Whether vision agrees with the scenario.
  bool is_done() const { return is_done_; }
  /// What is not as it should be, for a user. Precondition: !is_done().
  std::string problem() const;

  int placed() const { return static_cast<int>(placed_.size()); }
  int removed() const { return static_cast<int>(removed_.size()); }

 private:
  struct Place {
    Vec2 position_m{0, 0};
    std::optional<double> heading_rad;
  };
  /// A robot of the league, of which there are kRobotNumbers in each team.
  struct PlacedRobot {
    std::optional<Place> wanted;  ///< nullopt: is not to be on the floor
    std::optional<Place> seen;    ///< where it was seen since the last command
  };
  static constexpr std::size_t kTeams = 2;

  void see(Team team, const std::vector<league::DetectedRobot>& robots);
  bool is_right(const PlacedRobot& robot) const;
  // Preconditions of both: the robot is seen, and is to be on the floor.
  bool is_in_place(const PlacedRobot& robot) const;
  static double turned_rad(const PlacedRobot& robot);
  bool is_ball_right() const;
  std::vector<std::string> differences() const;
  league::SimulatorCommand removal();
  league::SimulatorCommand placement();

  Field field_;
  double tolerance_m_, tolerance_rad_;
  std::optional<BallSpec> ball_;
  std::array<std::array<PlacedRobot, league::kRobotNumbers>, kTeams> robots_;  ///< by team and number
  std::vector<Vec2> seen_balls_m_;
  bool has_seen_frame_ = false;
  bool has_removed_wrong_ = false;  ///< the last command removed robots; the next one places
  bool is_done_ = false, has_sent_ = false, has_placed_ball_ = false, has_answer_ = false;
  Time look_from_ = Time::min();
  std::optional<Time> judge_at_;
  std::vector<std::string> differences_;       ///< at the latest judgement
  std::vector<std::string> placed_, removed_;  ///< names of robots, each once
  std::string error_;                          ///< the simulator's latest
};

}  // namespace sidestep
