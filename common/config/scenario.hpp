// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/geometry/circle.hpp"
#include "common/geometry/field.hpp"
#include "common/image/image.hpp"
#include "common/motion/limits.hpp"
#include "common/motion/safety_budget.hpp"
#include "common/motion/version.hpp"
#include "common/time/time.hpp"

namespace sidestep {

enum class Team { kBlue, kYellow };

struct Goal {
  Vec2 position_m{0, 0};
  std::optional<double> heading_rad;  ///< none: as it comes
};

struct RobotSpec {
  RobotId id = 0;
  Team team = Team::kBlue;
  Vec2 start_m{0, 0};
  double start_heading_rad = 0;
  std::vector<Goal> goals;   ///< visited in order; at least one
  Duration clock_offset{0};  ///< the robot's clock is ahead of the host's by so much
  bool is_absent = false;    ///< not on the floor at the beginning; start_m says where it believes to be
};

/// Somebody who moves on the floor without asking: an opponent, a person.
struct OpponentSpec {
  double radius_m = 0.09;
  double speed_mps = 1;
  std::vector<Vec2> path_m;  ///< at least one point; to and fro, or round when it ends where it begins
};

struct BallSpec {
  Vec2 position_m{0, 0};
  Vec2 velocity_mps{0, 0};
};

/// Images instead of detections: what cameras send, and how they hang.
struct ImageSpec {
  PixelFormat format = PixelFormat::kYuv422;
  int width_px = 780;
  int height_px = 580;
  double camera_height_m = 4;
  double distortion = 0.1;  ///< k of common/camera/lens.hpp
};

/// The cameras hang over the field in a grid and see overlapping rectangles of it.
struct VisionSpec {
  double rate_hz = 60;
  int columns = 2;                   ///< cameras along the length
  int rows = 1;                      ///< cameras along the width
  double overlap_m = 0.5;            ///< by which a camera sees beyond its share of the field
  double position_noise_m = 0.0005;  ///< standard deviation per axis
  double heading_noise_rad = 0.005;  ///< standard deviation
  Duration delay{10'000'000};        ///< from capture to publication
  double missed = 0;                 ///< probability that a visible robot is not in a frame
  double ghosts = 0;  ///< probability that a frame holds a detection of a robot that is not there
  std::optional<ImageSpec> images;  ///< none: the simulator publishes detections, with the noise above
};

struct OdometrySpec {
  double scale_error = 0.005;        ///< standard deviation of each robot's constant relative error
  double velocity_noise_mps = 0.01;  ///< standard deviation per axis and millisecond of measurement
};

/// What SimBus does to messages between processes; over DDS the network is what it is.
struct NetworkSpec {
  double loss = 0;
  double duplicate = 0;
  Duration delay_min{200'000};
  Duration delay_max{600'000};  ///< drawn uniformly and independently for each message, so it reorders too
};

/// Which processes `sidestep run` starts again when they die. Not the simulator: it is the floor itself.
struct RestartSpec {
  bool agents = false;
  bool coordinator = false;
  bool vision = false;
};

/// Coordinators are numbered 0 .. kMaxCoordinators - 1.
inline constexpr std::uint32_t kMaxCoordinators = 8;

/// One run of the system, as a scenario file describes it (deploy/scenarios/README.md). Always valid: the
/// loader refuses everything else.
struct Scenario {
  std::string name;
  Field field;
  std::vector<RobotSpec> robots;  ///< ascending by id
  std::vector<Circle> obstacles;
  std::vector<OpponentSpec> opponents;
  double opponent_speed_mps = 1.5;  ///< that no opponent exceeds, as agents assume
  std::optional<BallSpec> ball;
  MotionLimits limits;
  double radius_m = 0.09;
  double margin_m = 0.01;  ///< at least what budget_of() needs
  double tracking_bound_m = SafetyBudget{}.tracking_bound_m;
  double clock_bound_s = SafetyBudget{}.clock_bound_s;
  Duration cycle{16'666'667};
  double goal_tolerance_m = 0.02;
  double time_limit_s =
      60;  ///< for all robots to arrive, from the first moment on which the coordinator grants
  VisionSpec vision;
  OdometrySpec odometry;
  double command_loss = 0;  ///< probability that a command is lost on the radio between agent and robot
  NetworkSpec network;
  RestartSpec restart;
  int coordinators = 1;  ///< with more than one, all but one stand by for it
};

SafetyBudget budget_of(const Scenario& scenario);

/// The robot with this id, or nullptr.
const RobotSpec* find_robot(const Scenario& scenario, RobotId id);

/// A robot's number within its team, 0 .. 15: the pattern that it wears, and what the league's packets call
/// it.
constexpr std::uint32_t number_of(RobotId id) { return id % 16; }
/// The first robot with this number in the team, or nullptr.
const RobotSpec* find_robot(const Scenario& scenario, Team team, std::uint32_t number);
/// Throws std::invalid_argument when two robots of one team have one number, so that patterns and packets
/// cannot tell them apart.
void require_own_numbers(const Scenario& scenario);

}  // namespace sidestep
