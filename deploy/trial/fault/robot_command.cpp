// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/fault/robot_command.hpp"

#include <cmath>
#include <fmt/format.h>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/client/disturbance_client.hpp"
#include "common/file/console.hpp"
#include "common/messaging/dds/bus.hpp"
#include "common/messaging/disturbance_answer.hpp"
#include "common/motion/version.hpp"
#include "common/process/command_line.hpp"
#include "common/process/process.hpp"
#include "common/protocol/robot_disturbance.hpp"
#include "common/yaml/heading.hpp"
#include "deploy/trial/fault/operator_messages.hpp"

namespace sidestep {
namespace {

using Kind = msg::DisturbanceKind;

struct RobotOptions {
  RobotId robot = 0;
  std::vector<double> velocity_mps;
  std::vector<double> position_m;
  double heading_rad = 0;
  double grip = 0;
  double seconds = 1;
  double offset_ms = 0;
  DdsSettings dds;
};

msg::Disturbance disturbance_from(const RobotOptions& options, Kind kind) {
  msg::Disturbance disturbance;
  disturbance.robot(options.robot);
  disturbance.disturbance_kind(kind);
  if (!options.velocity_mps.empty()) {
    disturbance.vx_mps(options.velocity_mps[0]);
    disturbance.vy_mps(options.velocity_mps[1]);
  }
  if (!options.position_m.empty()) {
    disturbance.x_m(options.position_m[0]);
    disturbance.y_m(options.position_m[1]);
  }
  disturbance.grip(options.grip);
  disturbance.heading_rad(options.heading_rad);
  disturbance.clock_offset_ns(std::llround(options.offset_ms * 1e6));
  disturbance.duration_ns(std::llround(options.seconds * 1e9));
  return disturbance;
}

int disturb(const RobotOptions& options, Kind kind) {
  // The simulator must have found this process's reader before it answers.
  DdsSettings answers = options.dds;
  answers.is_operator = true;
  DdsBus bus(answers);
  OperatorChannel channel(options.dds, topics::kDisturbance);
  DisturbanceClient client(bus, channel.writer());
  (void)wait_for_targets(channel, options.dds, "sidestep-simulator");
  wait_for_writer(channel, channel_name(topics::kFeedback, options.robot),
                  fmt::format("no robot {} in this run", options.robot));
  // The robot's agent must request the rest version at this position.
  if (kind == Kind::DISTURBANCE_PLACE)
    (void)wait_for_targets(channel, options.dds, fmt::format("agent-{}", options.robot));
  std::optional<msg::DisturbanceResult> answer;
  client.send(disturbance_from(options, kind), [&](const std::optional<msg::DisturbanceResult>& result) {
    answer = result;
    bus.stop();
  });
  bus.run();
  if (!answer)
    throw std::runtime_error("the simulator does not answer, so the fault may or may not have been applied");
  if (*answer != msg::DisturbanceResult::FAULT_APPLIED)
    throw std::runtime_error("the simulator refuses the fault: " + refusal_text(options.robot, *answer));
  wait_until_acknowledged(channel);
  print_output("applied by the simulator{}\n", kind == Kind::DISTURBANCE_PLACE
                                                   ? ", which puts the robot down once the place is granted"
                                                   : "");
  return 0;
}

}  // namespace

void add_robot_commands(const CliCommand& fault, std::function<int()>& action) {
  const auto options = std::make_shared<RobotOptions>();
  options->dds.participant = "sidestep-fault";
  options->dds.identity = {Role::kOperator};
  const auto add = [&](const char* name, const char* description, Kind kind) {
    const CliCommand command = fault.add_subcommand(name, description);
    command.add_option("ROBOT", options->robot, "robot id").required().check(in_range(0U, kMaxRobots - 1));
    add_dds_options(command, options->dds);
    command.on_parsed(
        [options, kind, &action] { action = [options, kind] { return disturb(*options, kind); }; });
    return command;
  };
  const auto add_seconds = [&](const CliCommand command) {
    command.add_option("--seconds", options->seconds, "duration")
        .check(in_range(0.001, 3600.0))
        .show_default();
  };
  const auto add_pair = [&](const CliCommand& command, const char* name, std::vector<double>& pair,
                            double max, const char* description) {
    command.add_option(name, pair, description).required().comma_separated(2).check(in_range(-max, max));
  };
  const ValueCheck angle{
      "-6.28 to 6.28", [](const std::string& text) {
        const bool is_number = in_range(-1e9, 1e9).problem(text).empty();
        return is_number ? heading_problem(std::stod(text))
                         : fmt::format("expected a heading of -6.28 to 6.28 radians, got \"{}\"", text);
      }};

  const CliCommand push = add("push", "Changes a robot's velocity instantly", Kind::DISTURBANCE_PUSH);
  add_pair(push, "--velocity", options->velocity_mps, kMaxPush_mps, "velocity change X,Y in m/s");
  const CliCommand slip = add("slip", "Reduces the grip of a robot's wheels", Kind::DISTURBANCE_SLIP);
  slip.add_option("--grip", options->grip, "share of the commanded acceleration that takes effect")
      .required()
      .check(in_range(0.0, 1.0));
  add_seconds(slip);
  const CliCommand block = add("block", "Blocks a wheel of a robot", Kind::DISTURBANCE_BLOCK);
  block.add_option("--heading", options->heading_rad, "the wheel's direction in the body frame, in rad")
      .check(angle);
  add_seconds(block);
  add("lift", "Takes a robot off the floor", Kind::DISTURBANCE_LIFT);
  const CliCommand place =
      add("place", "Puts a lifted robot down once it is granted this place", Kind::DISTURBANCE_PLACE);
  add_pair(place, "--at", options->position_m, 1000, "position X,Y in m");
  place.add_option("--heading", options->heading_rad, "in rad").check(angle);
  add("reboot", "Restarts a robot's firmware", Kind::DISTURBANCE_REBOOT);
  add("forget-pose", "Restarts a robot's firmware, which then does not know where it is",
      Kind::DISTURBANCE_FORGET_POSE);
  add("switch-off", "Takes a robot's power away: it rolls freely", Kind::DISTURBANCE_SWITCH_OFF);
  add("switch-on", "Gives a robot its power back", Kind::DISTURBANCE_SWITCH_ON);
  const CliCommand carry =
      add("carry", "Moves a robot by hand, close above the floor", Kind::DISTURBANCE_CARRY);
  add_pair(carry, "--to", options->position_m, 1000, "position X,Y in m");
  add_seconds(carry);
  const CliCommand clock =
      add("clock", "Sets a robot's clock relative to its host's clock", Kind::DISTURBANCE_CLOCK);
  clock.add_option("--offset-ms", options->offset_ms, "positive: ahead, negative: behind")
      .required()
      .check(in_range(-1e6, 1e6));
}

}  // namespace sidestep
