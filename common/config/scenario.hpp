// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/collision/shapes.hpp"
#include "common/geometry/field.hpp"
#include "common/image/image.hpp"
#include "common/map/laser_settings.hpp"
#include "common/motion/floor_rules.hpp"
#include "common/motion/goal.hpp"
#include "common/motion/limits.hpp"
#include "common/motion/safety_budget.hpp"
#include "common/motion/version.hpp"
#include "common/time/time.hpp"

namespace sidestep {

enum class Team { kBlue, kYellow };

struct RobotSpec {
  RobotId id = 0;
  Team team = Team::kBlue;
  Vec2 start_m{0, 0};
  double start_heading_rad = 0;
  std::vector<Goal> goals;     ///< visited in order; may be empty
  std::string planner{};       ///< the robot's planner (named_planner.hpp); empty: the scenario's planner
  Duration clock_offset{0};    ///< robot's clock - host's clock, at the start
  double clock_drift_ppm = 0;  ///< rate at which the robot's clock gains on the host's
  bool is_absent = false;      ///< not on the floor at the start; start_m is then the robot's own estimate
};

/// A moving obstacle outside the protocol: an opponent or a person.
struct OpponentSpec {
  double radius_m = 0.09;
  double speed_mps = 1;
  std::vector<Vec2> path_m;  ///< at least one point; back and forth, or in a loop if both ends coincide
};

struct BallSpec {
  Vec2 position_m{0, 0};
  Vec2 velocity_mps{0, 0};
};

/// The camera mounting, and the images that cameras send instead of detections.
struct ImageSpec {
  PixelFormat format = PixelFormat::kYuv422;
  int width_px = 780;
  int height_px = 580;
  double camera_height_m = 4;
  double distortion = 0.1;  ///< coefficient k in common/camera/lens.hpp
};

/// The cameras form a grid above the field and see overlapping rectangles of it.
struct VisionSpec {
  double rate_hz = 60;
  int columns = 2;                        ///< number of cameras along the length
  int rows = 1;                           ///< number of cameras along the width
  double overlap_m = 0.5;                 ///< distance by which a camera's view extends beyond its grid cell
  double position_noise_m = 0.0005;       ///< standard deviation on each axis
  double heading_noise_rad = 0.005;       ///< standard deviation
  Duration delay{10'000'000};             ///< time from capture to publication
  double miss_probability = 0;            ///< probability that a visible robot is missing from a frame
  double ghost_probability = 0;           ///< probability of a false detection of a robot in a frame
  double ghost_obstacle_probability = 0;  ///< probability of a false obstacle in a frame
  /// Whether league packets may arrive on any network interface, not only on loopback.
  bool has_league_everywhere = false;
  std::optional<ImageSpec> images;  ///< nullopt: the simulator publishes detections with the noise above
};

struct OdometrySpec {
  double scale_error = 0.005;        ///< standard deviation of each robot's constant relative error
  double velocity_noise_mps = 0.01;  ///< standard deviation per axis of each measurement
};

/// The laser scanner on each robot, and what robots assume about it. Robots with lasers learn of opponents
/// and people only from their own scans.
struct LaserSpec {
  LaserSettings settings;
  double rate_hz = 15;
  double range_error_m = 0.03;     ///< maximum error of a range
  double dropout_probability = 0;  ///< probability that a beam is lost
  double person_radius_m = 0.15;   ///< radius of the smallest person at laser height
};

/// The impairments of messages on SimBus. They do not apply to DDS.
struct NetworkSpec {
  double loss = 0;
  double duplicate = 0;
  Duration delay_min{200'000};
  Duration delay_max{600'000};  ///< uniform and independent per message, so messages are also reordered
};

/// The processes that `sidestep run` restarts when they die. The simulator is never restarted, because it
/// holds the ground truth.
struct RestartSpec {
  bool agents = false;
  bool coordinator = false;
  bool vision = false;
  bool robots = false;  ///< sidestep-robot, with `run --driver`
};

/// The floor, its robots, and the rules that they keep: the part of a scenario that every process uses.
struct FloorSpec {
  std::string name;  ///< of the scenario
  Field field;
  std::vector<RobotSpec> robots;  ///< ascending by id
  std::vector<Shape> obstacles;
  std::shared_ptr<const FloorMap> map;  ///< additional obstacles; null: none
  double max_opponent_speed_mps = 1.5;  ///< upper bound of opponents' speed that agents assume
  MotionLimits limits;
  double radius_m = 0.09;
  double margin_m = 0.014;  ///< at least budget_of().required_margin_m()
  double tracking_bound_m = SafetyBudget{}.tracking_bound_m;
  double clock_bound_s = SafetyBudget{}.clock_bound_s;
  Duration cycle{16'666'667};
  std::string planner = "lazy-visibility";  ///< planner for the routes of all robots
  double goal_tolerance_m = 0.02;
  std::optional<LaserSpec> laser;  ///< nullopt: vision sees opponents and people
  int coordinators = 1;            ///< number of coordinators: one is active, the others are standbys
};

/// The world that is simulated around the robots, with its cameras and its network.
struct SimulationSpec {
  std::vector<OpponentSpec> opponents;
  std::optional<BallSpec> ball;
  VisionSpec vision;
  OdometrySpec odometry;
  double command_loss = 0;  ///< probability that the radio link between agent and robot drops a command
  NetworkSpec network;
};

/// How a run is started and ended.
struct LaunchSpec {
  double time_limit_s = 60;  ///< limit for all robots to arrive, counted from the coordinator's first grants
  RestartSpec restart;
  bool has_test_keys = false;  ///< the file has `faults` or `expect`, which only `sidestep test` applies
};

/// One run of the system, as described by a scenario file (deploy/scenarios/README.md). The loader rejects
/// invalid scenarios.
struct Scenario : FloorSpec, SimulationSpec, LaunchSpec {};

FloorRules floor_rules(const FloorSpec& floor);
SafetyBudget budget_of(const FloorSpec& floor);

/// The ids of all robots on the floor, ascending.
std::vector<RobotId> roster_of(const FloorSpec& floor);

/// The robot with an id, or nullptr.
const RobotSpec* find_robot(const FloorSpec& floor, RobotId id);

/// A robot's number within its team, 0 .. 15: the id of its marker pattern and its id in the league's
/// packets.
constexpr std::uint32_t number_in_team(RobotId id) { return id % 16; }
/// The first robot of a team with this number, or nullptr.
const RobotSpec* find_robot(const FloorSpec& floor, Team team, std::uint32_t number);
/// Throws std::invalid_argument if two robots of a team have the same number, because neither marker patterns
/// nor league packets could distinguish them.
void require_unique_numbers(const FloorSpec& floor);

}  // namespace sidestep
