// SPDX-License-Identifier: Apache-2.0
#include "deploy/fault/robot_command.hpp"

#include <CLI/CLI.hpp>
#include <cmath>
#include <fmt/format.h>
#include <memory>
#include <numbers>
#include <vector>

#include "common/motion/version.hpp"
#include "common/process/process.hpp"
#include "deploy/fault/orders.hpp"

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

msg::Disturbance order_from(const RobotOptions& options, Kind kind) {
  msg::Disturbance order;
  order.robot(options.robot);
  order.head(order_head());
  order.disturbance_kind(kind);
  if (!options.velocity_mps.empty()) {
    order.vx_mps(options.velocity_mps[0]);
    order.vy_mps(options.velocity_mps[1]);
  }
  if (!options.position_m.empty()) {
    order.x_m(options.position_m[0]);
    order.y_m(options.position_m[1]);
  }
  order.grip(options.grip);
  order.heading_rad(options.heading_rad);
  order.clock_offset_ns(std::llround(options.offset_ms * 1e6));
  order.duration_ns(std::llround(options.seconds * 1e9));
  return order;
}

int disturb(const RobotOptions& options, Kind kind) {
  OperatorChannel orders(options.dds, topics::kDisturbance);
  wait_for_taker(orders, "sidestep-simulator");
  wait_for_writer(orders, channel_name(topics::kFeedback, options.robot),
                  fmt::format("there is no robot {} on this floor", options.robot));
  // The place that the owner names is its agent's to ask for.
  if (kind == Kind::DISTURBANCE_PLACE) wait_for_taker(orders, fmt::format("agent-{}", options.robot));
  const msg::Disturbance order = order_from(options, kind);
  orders.writer().write(&order);
  wait_until_taken(orders);
  fmt::print("taken by the simulator\n");
  return 0;
}

}  // namespace

void add_robot_commands(CLI::App& fault, std::function<int()>& action) {
  const auto options = std::make_shared<RobotOptions>();
  options->dds.participant = "sidestep-fault";
  const auto add = [&](const char* name, const char* description, Kind kind) {
    CLI::App* command = fault.add_subcommand(name, description);
    command->add_option("ROBOT", options->robot, "its id")->required()->check(CLI::Range(0U, kMaxRobots - 1));
    add_dds_options(*command, options->dds);
    command->callback(
        [options, kind, &action] { action = [options, kind] { return disturb(*options, kind); }; });
    return command;
  };
  const auto add_seconds = [&](CLI::App* command) {
    command->add_option("--seconds", options->seconds, "for how long")
        ->check(CLI::Range(0.001, 3600.0))
        ->capture_default_str();
  };
  const auto add_pair = [&](CLI::App* command, const char* name, std::vector<double>& pair, double most,
                            const char* description) {
    command->add_option(name, pair, description)
        ->required()
        ->delimiter(',')
        ->expected(2)
        ->check(CLI::Range(-most, most));
  };
  const CLI::Range angle(-2 * std::numbers::pi, 2 * std::numbers::pi);

  CLI::App* push = add("push", "Changes a robot's velocity at once", Kind::DISTURBANCE_PUSH);
  add_pair(push, "--velocity", options->velocity_mps, 20, "by X,Y in m/s");
  CLI::App* slip = add("slip", "Takes grip from a robot's wheels", Kind::DISTURBANCE_SLIP);
  slip->add_option("--grip", options->grip, "share of an acceleration that reaches the floor")
      ->required()
      ->check(CLI::Range(0.0, 1.0));
  add_seconds(slip);
  CLI::App* block = add("block", "Blocks a wheel", Kind::DISTURBANCE_BLOCK);
  block->add_option("--heading", options->heading_rad, "the wheel's direction on the body, in radians")
      ->check(angle);
  add_seconds(block);
  add("lift", "Takes a robot off the floor", Kind::DISTURBANCE_LIFT);
  CLI::App* place =
      add("place", "Puts a lifted robot down, once it may stand there", Kind::DISTURBANCE_PLACE);
  add_pair(place, "--at", options->position_m, 1000, "X,Y in m");
  place->add_option("--heading", options->heading_rad, "in radians")->check(angle);
  add("reboot", "Starts a robot's firmware again", Kind::DISTURBANCE_REBOOT);
  CLI::App* clock = add("clock", "Sets a robot's clock ahead of its host's", Kind::DISTURBANCE_CLOCK);
  clock->add_option("--offset-ms", options->offset_ms, "negative: behind")
      ->required()
      ->check(CLI::Range(-1e6, 1e6));
}

}  // namespace sidestep
