// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/order/order_command.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <memory>
#include <optional>
#include <string>
#include <unistd.h>
#include <utility>
#include <vector>

#include "common/client/order_client.hpp"
#include "common/file/console.hpp"
#include "common/messaging/dds/bus.hpp"
#include "common/messaging/order_codec.hpp"
#include "common/messaging/version_codec.hpp"
#include "common/process/network_text.hpp"
#include "common/process/process.hpp"
#include "common/process/stop_signals.hpp"
#include "common/protocol/client_text.hpp"
#include "common/terminal/redrawn_text.hpp"
#include "common/terminal/terminal.hpp"
#include "common/yaml/yaml_document.hpp"
#include "deploy/run/order/goal_text.hpp"
#include "deploy/run/order/order_session.hpp"
#include "deploy/run/order/order_text.hpp"
#include "deploy/run/order/robot_watch.hpp"
#include "deploy/run/order/zone_text.hpp"

namespace sidestep {
namespace {

constexpr Duration kTablePeriod = std::chrono::milliseconds(200);
constexpr Duration kOnceDuration = std::chrono::milliseconds(1500);
// How much longer `--once` may take to find out what hinders the robots.
constexpr int kMaxOncePolls = 20;
constexpr Duration kOncePollPeriod = std::chrono::milliseconds(100);

GoalLists goals_of(const OrderOptions& options) {
  if (!options.file.empty())
    return parse_goal_lists(read_yaml_file(options.file, "goals of robots"), options.file);
  GoalLists lists;
  for (const std::string& text : options.goals) lists[options.robot].push_back(parse_goal(text));
  return lists;
}

Zone zone_of(const OrderOptions& options) {
  const double limit_mps = options.speed_limit_mps;
  return parse_zone(options.corners, options.radius_m,
                    limit_mps > 0 ? std::optional(limit_mps) : std::nullopt);
}

int go(const OrderOptions& options) {
  GoalLists lists = goals_of(options);
  for (auto& [robot, goals] : lists) {
    for (Goal& goal : goals) {
      if (options.speed_limit_mps > 0) goal.speed_limit_mps = options.speed_limit_mps;
      if (options.tolerance_m > 0) goal.tolerance_m = options.tolerance_m;
    }
  }
  OrderSession session(options);
  std::vector<OrderHandle> handles;
  for (const auto& [robot, goals] : lists) handles.push_back(session.client().go(robot, goals));
  return session.finish(handles);
}

int show_status(const OrderOptions& options) {
  DdsBus bus(dds_of(options));
  const StopSignals stop_signals([&bus] { bus.stop(); });
  const OrderClient client(bus, client_of(options));
  RobotWatch watch(bus, client, !options.dds.keys.empty());
  watch.watch_all();
  if (options.once || !terminal_of(STDOUT_FILENO).can_redraw) {
    bus.run_until(bus.now() + kOnceDuration);
    for (int i = 0; i < kMaxOncePolls && !watch.is_complete(); ++i)
      bus.run_until(bus.now() + kOncePollPeriod);
    write_output(to_table(client.reports(), watch.all_hindrances()));
  } else {
    RedrawnText table(stdout);
    const auto refresh = [&] { table.draw(to_table(client.reports(), watch.all_hindrances())); };
    refresh();
    call_periodically(bus, kTablePeriod, refresh);
    bus.run();
  }
  if (!client.reports().empty()) return 0;
  fmt::print(stderr, "sidestep: no agent is heard {}\n", network_text(options.dds));
  return kExitFailure;
}

using Options = std::shared_ptr<OrderOptions>;

Options add_command(const CliCommand& command) {
  const auto options = std::make_shared<OrderOptions>();
  options->dds.participant = "sidestep-order";
  options->dds.identity = {Role::kOperator};
  options->dds.is_operator = true;
  add_dds_options(command, options->dds);
  return options;
}

void add_client_option(const CliCommand& command, const Options& options) {
  command.add_option("--client", options->client,
                     "send as this client instead of the operator, whose orders take precedence");
}

void add_go(const CliCommand& root, std::function<int()>& action) {
  const CliCommand command = root.add_subcommand("go", "Sends robots to sequences of goals");
  const Options options = add_command(command);
  add_client_option(command, options);
  const auto robot = command.add_option(
      "ROBOT", [options](const std::string& text) { options->robot = parse_robots(text); }, "robot id");
  const auto goals = command.add_option("GOAL", options->goals, "X,Y[,HEADING] in metres and radians");
  const auto file = command.add_option("--file", options->file,
                                       "YAML file with lines such as \"3: [[1.2, -0.4], [0, 0, 1.57]]\"");
  command.add_option("--speed", options->speed_limit_mps, "speed limit on the way, m/s")
      .check(in_range(kMinSpeedLimit_mps, kMaxSpeed_mps));
  command.add_option("--tolerance", options->tolerance_m, "distance from a goal that counts as arrival, m")
      .check(in_range(kMinTolerance_m, kMaxTolerance_m));
  const auto wait = command.add_flag("--wait", options->waits,
                                     "wait until all robots have arrived, and say what hinders them");
  command.add_option("--timeout", options->timeout_s, "give up waiting after this time, s [never]")
      .check(positive())
      .needs(wait);
  command.on_parsed([=, &action] {
    if (file.is_given() == robot.is_given()) throw UsageError("expected either ROBOT and GOAL, or --file");
    if (robot.is_given() && !goals.is_given()) throw UsageError("GOAL is missing: expected X,Y[,HEADING]");
    if (options->robot == kAllRobots) throw UsageError("expected one robot, or --file");
    if (options->goals.size() > msg::MAX_ORDER_POSES)
      throw UsageError(fmt::format("expected at most {} goals", msg::MAX_ORDER_POSES));
    for (const std::string& goal : options->goals) (void)parse_goal(goal);
    action = [options] { return go(*options); };
  });
}

void add_simple(const CliCommand& root, std::function<int()>& action, const char* name,
                const char* description, bool allows_all, OrderHandle (OrderClient::*send)(RobotId)) {
  const CliCommand command = root.add_subcommand(name, description);
  const Options options = add_command(command);
  add_client_option(command, options);
  command
      .add_option(
          "ROBOT", [options](const std::string& text) { options->robot = parse_robots(text); },
          allows_all ? "robot id, or all" : "robot id")
      .required();
  command.on_parsed([=, &action] {
    if (!allows_all && options->robot == kAllRobots) throw UsageError("expected one robot");
    action = [=] {
      OrderSession session(*options);
      const OrderHandle handle = (session.client().*send)(options->robot);
      const bool may_leave_holds = send == &OrderClient::resume && !options->client.empty();
      return may_leave_holds ? session.finish_resume(handle) : session.finish({handle});
    };
  });
}

int zone(const OrderOptions& options) {
  OrderSession session(options);
  if (!options.removes) return session.finish({session.client().zone(options.zone, zone_of(options))});
  if (const auto others = session.zones_without(options.zone)) {
    print_output("{}\n",
                 unknown_zone_text(options.zone, client_of(options), client_name(options.client), *others));
    return kExitFailure;
  }
  return session.finish({session.client().remove_zone(options.zone)});
}

void add_zone(const CliCommand& root, std::function<int()>& action) {
  const CliCommand command = root.add_subcommand(
      "zone", "Sets a zone for all robots: to keep out of or, with --speed, to drive slowly in");
  const Options options = add_command(command);
  add_client_option(command, options);
  command
      .add_option("NUMBER", options->zone,
                  "zone number, chosen by the client; a later zone of this number replaces it")
      .required();
  const auto corners = command.add_option(
      "CORNER", options->corners, "X,Y in metres; the zone is the convex hull of all corners, plus --radius");
  const auto radius = command.add_option("--radius", options->radius_m, "radius added to the hull, m")
                          .check(in_range(0, kMaxCoordinate_m));
  const auto speed = command.add_option("--speed", options->speed_limit_mps, "speed limit in the zone, m/s")
                         .check(in_range(kMinSpeedLimit_mps, kMaxSpeed_mps));
  command.add_flag("--remove", options->removes, "remove the zone of this number")
      .excludes(corners)
      .excludes(radius)
      .excludes(speed);
  command.on_parsed([=, &action] {
    if (!options->removes) (void)zone_of(*options);
    action = [options] { return zone(*options); };
  });
}

}  // namespace

void add_order_commands(const CliCommand& root, std::function<int()>& action) {
  add_go(root, action);
  add_simple(root, action, "cancel",
             "Cancels the operator's drive order; the robot continues with other clients' orders", false,
             &OrderClient::cancel);
  add_simple(root, action, "hold",
             "Stops robots until they are resumed. Not a certified emergency stop: it needs a coordinator",
             true, &OrderClient::hold);
  add_simple(root, action, "resume", "Ends the holds of this client; without --client, ends all holds", true,
             &OrderClient::resume);
  add_zone(root, action);
  const CliCommand status =
      root.add_subcommand("status", "Shows how robots carry out their orders, and what hinders them");
  const Options options = add_command(status);
  status.add_flag("--once", options->once, "print the table once, and exit");
  status.on_parsed([options, &action] { action = [options] { return show_status(*options); }; });
}

}  // namespace sidestep
