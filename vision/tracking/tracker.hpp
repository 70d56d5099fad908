// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/motion/rolling_ball.hpp"
#include "common/protocol/drop_counters.hpp"
#include "idl/vision.hpp"
#include "vision/tracking/frame.hpp"
#include "vision/tracking/obstacle_tracker.hpp"
#include "vision/tracking/track.hpp"

namespace sidestep {

struct TrackerSettings {
  TrackModel robot;
  TrackModel ball = ball_model();
  ObstacleTrackerSettings obstacles;
  /// A robot's observation is not used if the uncertainty of its date may displace it by more. The robot then
  /// navigates by its wheels, and slows down before its drift exceeds the tracking bound.
  double max_date_error_m = vision_error_bound_m(SafetyBudget{}.tracking_bound_m);
  // The ball bounces off the field's walls, these obstacles, the map, and robots of this radius.
  Field field;
  std::vector<Shape> floor_obstacles;
  std::shared_ptr<const FloorMap> map;  // may be null
  double robot_radius_m = 0.09;

  /// A ball has no heading, rolls with friction, and changes velocity abruptly when it is kicked.
  static TrackModel ball_model();
};

/// Settings for the cameras and robots of a scenario.
[[nodiscard]] TrackerSettings tracker_settings(const Scenario& scenario);

/// Fuses the frames of all cameras, in any order of arrival, into one world state. Ignores robots that are
/// not on the roster. Allocates only in the constructor, and for obstacles in the same cases as
/// ObstacleTracker.
class Tracker {
 public:
  /// Precondition: the roster's numbers are below kMaxRobots.
  Tracker(const TrackerSettings& settings, std::span<const RobotId> roster);

  void update(const Frame& frame);
  /// The standard deviation of what cameras that disagree show. Observations of robots count as no more
  /// accurate than this. It adds to the uncertainty of obstacles.
  void set_camera_error(double position_error_m);
  /// The standard deviation of a robot's observed position on each axis, by the settings.
  double configured_noise_m() const { return configured_noise_m_; }
  /// Forgets all observations. Call when the clock was set back: later observations would seem older.
  void forget();
  /// Adds the counts of detections that were not used.
  void count_drops(DropCounters& drops) const;
  /// Fills in valid_at_ns, the number of frames, and the ball and robots extrapolated from their last
  /// observations to this time. Robots are sorted by number. An unobserved ball bounces off everything known
  /// on the floor. Allocates if the message has not yet contained as many robots.
  void world_at(Time t, msg::WorldState& world) const;
  /// Fills in everything except the header, for the time and the robots of a world state: obstacles at their
  /// last observations. Allocates if the message has not yet contained as many obstacles.
  void obstacles_at(const msg::WorldState& world, msg::ObstacleList& list);

 private:
  /// Whether the date of the frame is too uncertain for the speed of the robot.
  bool is_misplaced(const Frame& frame, const TrackState& robot) const;
  State ball_at(Time t, const msg::WorldState& world) const;

  static constexpr std::uint16_t kNotInRoster = kMaxRobots;

  TrackerSettings settings_;
  double configured_noise_m_;                         ///< position noise of robots by the settings
  std::vector<RobotId> roster_;                       ///< sorted
  std::array<std::uint16_t, kMaxRobots> index_of_{};  ///< index in the roster, or kNotInRoster
  std::vector<Track> robots_;                         ///< parallel to the roster
  Track ball_;
  ObstacleTracker obstacles_;
  std::uint64_t frames_ = 0;
  // Number of detections that were not used, not counting those rejected by tracks.
  std::uint64_t malformed_ = 0, unknown_ = 0, untimely_frames_ = 0, malformed_frames_ = 0, misplaced_ = 0;
};

}  // namespace sidestep
