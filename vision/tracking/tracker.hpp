// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/motion/rolling_ball.hpp"
#include "idl/vision.h"
#include "vision/tracking/frame.hpp"
#include "vision/tracking/obstacle_tracker.hpp"
#include "vision/tracking/track.hpp"

namespace sidestep {

struct TrackerSettings {
  TrackModel robot;
  TrackModel ball = ball_model();
  ObstacleSettings obstacles;
  Field field;                          ///< off whose walls the ball bounces,
  std::vector<Circle> floor_obstacles;  ///< and off these,
  double robot_radius_m = 0.09;         ///< and off robots

  /// A ball keeps no heading, rolls with friction and is kicked: fast, and suddenly elsewhere.
  static TrackModel ball_model();
};

/// Settings for the cameras and the robots of a scenario.
TrackerSettings tracker_settings(const Scenario& scenario);

/// Fuses the frames of all cameras, in whatever order they come, into one world. Robots that are not in the
/// roster do not exist for it. Allocates only when it is made.
class Tracker {
 public:
  /// Numbers in the roster are below kMaxRobots.
  Tracker(const TrackerSettings& settings, std::span<const RobotId> roster);

  void update(const Frame& frame);
  /// Fills in valid_at_ns, counters, ball and robots as they are at a time, by extrapolation from their last
  /// sight, and obstacles as they were at their last sight; ascending by number. The ball bounces off what is
  /// known to be in its way, as long as nobody sees it. Allocates when the message has held fewer robots so
  /// far.
  void world_at(Time t, msg::WorldState& world) const;

 private:
  State ball_at(Time t, const msg::WorldState& world) const;

  static constexpr std::uint16_t kStranger = kMaxRobots;

  TrackerSettings settings_;
  std::vector<RobotId> roster_;                     ///< ascending
  std::array<std::uint16_t, kMaxRobots> index_of_;  ///< place in the roster, or kStranger
  std::vector<Track> robots_;                       ///< as the roster
  Track ball_;
  ObstacleTracker obstacles_;
  std::uint64_t frames_ = 0;
  std::uint64_t rejected_ = 0;
};

}  // namespace sidestep
