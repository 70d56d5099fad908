// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/geometry/vec2.hpp"
#include "common/league/decode_error.hpp"

namespace sidestep::league {

/// The commanded motion of a robot in the league's simulation.
struct RobotMove {
  enum class Kind : std::uint8_t { kWheels, kLocal, kGlobal };
  Kind kind = Kind::kLocal;
  Vec2 linear_mps{0, 0};  ///< local: forward, left; global: x, y; not used for wheels
  double turn_radps = 0;
};

struct RobotCommand {
  std::uint32_t number = 0;
  std::optional<RobotMove> move;
  double kick_mps = 0;  ///< 0: no kick
  double kick_angle_rad = 0;
};

/// RobotControl: the commands for one team.
struct TeamCommands {
  std::vector<RobotCommand> robots;
};

struct SimulatorError {
  std::string code, message;
};

struct RobotFeedback {
  std::uint32_t number = 0;
  bool has_ball = false;  ///< the ball touches the robot's dribbler
};

/// RobotControlResponse: the answer to TeamCommands.
struct TeamResponse {
  std::vector<SimulatorError> errors;
  std::vector<RobotFeedback> feedback;
};

struct BallTeleport {
  std::optional<Vec2> position_m, velocity_mps;
};

struct RobotTeleport {
  Team team = Team::kBlue;
  std::uint32_t number = 0;
  std::optional<double> x_m, y_m, heading_rad;
  Vec2 velocity_mps{0, 0};
  double turn_radps = 0;
  std::optional<bool> is_present;
};

struct SimulatorCommand {
  std::optional<BallTeleport> ball;
  std::vector<RobotTeleport> robots;
  std::optional<double> speed;  ///< speed of the simulation relative to real time
  bool has_geometry = false, has_robot_specs = false, has_realism = false;
  std::optional<std::uint32_t> vision_port;
};

struct SimulatorResponse {
  std::vector<SimulatorError> errors;
};

/// Encode the payload of a datagram. Precondition: the numbers are in the ranges that the decoders accept.
std::vector<std::byte> encode(const TeamCommands& packet);
std::vector<std::byte> encode(const TeamResponse& packet);
std::vector<std::byte> encode(const SimulatorCommand& packet);
std::vector<std::byte> encode(const SimulatorResponse& packet);

/// Decode a datagram. A packet is rejected as a whole if any value in it is invalid: speeds beyond 100 m/s or
/// 1000 rad/s, coordinates beyond kMaxCoordinate_m, headings beyond 7 rad, robot numbers above 15, more than
/// 64 robots or errors, or more than 4096 entries of feedback.
Decoded<TeamCommands> decode_team_commands(std::span<const std::byte> bytes);
Decoded<TeamResponse> decode_team_response(std::span<const std::byte> bytes);
Decoded<SimulatorCommand> decode_simulator_command(std::span<const std::byte> bytes);
Decoded<SimulatorResponse> decode_simulator_response(std::span<const std::byte> bytes);

}  // namespace sidestep::league
