// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "common/config/scenario_loader.hpp"
#include "common/protocol/order.hpp"
#include "deploy/audit/metrics/report.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "tests/catch.hpp"

namespace sidestep {

inline constexpr auto kOperator = static_cast<ClientId>(Sender::kOperator);
inline constexpr ClientId kClient = 1'000'001, kOtherClient = 1'000'002;
inline constexpr double kAtRest_mps = 0.02;  // above the noise of a robot that holds its position

/// Robots without goals, on two sides of the field.
inline Scenario waiting_robots(int count, int coordinators = 1, const std::string& more = "") {
  std::string text =
      "field: {length_m: 6, width_m: 5}\ntime_limit_s: 60\ncoordinators: " + std::to_string(coordinators) +
      "\n" + more + "robots:\n";
  for (int i = 0; i < count; ++i)
    text += "  - {id: " + std::to_string(i) + ", start_m: [" + (i % 2 ? "2" : "-2") + ", " +
            std::to_string(-1.5 + 0.5 * (i / 2)) + "]}\n";
  return parse_scenario(text, "waiting.yaml");
}

/// A whole system on SimBus to which clients give orders, with checks of the outcome.
struct OrderedSystem {
  Scenario scenario;
  SimSystem system;
  std::map<RobotId, msg::OrderStatus> statuses;
  std::map<OrderNumber, msg::OrderResult> answers;
  std::set<OrderNumber> arrived;
  std::map<RobotId, State> bodies;  ///< true states of the robots
  Vec2 ball_m{0, 0};                ///< true position of the ball
  OrderNumber number = 0;
  Time moved_at{};  ///< time at which a robot last moved

  OrderedSystem(const Scenario& s, std::uint64_t seed) : scenario(s), system(scenario, seed) {
    system.observer_bus().subscribe(topics::kOrderStatus, [this](const msg::OrderStatus& status) {
      statuses[status.robot()] = status;
      if (status.order_state() == msg::OrderState::ORDER_ARRIVED) arrived.insert(status.order_number());
    });
    system.observer_bus().subscribe(topics::kTruth, [this](const msg::GroundTruth& truth) {
      ball_m = {truth.ball_x_m(), truth.ball_y_m()};
      for (const msg::TrueRobotState& robot : truth.robots()) {
        bodies[robot.robot()] = {{robot.x_m(), robot.y_m()}, {robot.vx_mps(), robot.vy_mps()}};
        if (std::hypot(robot.vx_mps(), robot.vy_mps()) > kAtRest_mps)
          moved_at = time_from_ns(truth.valid_at_ns());
      }
    });
    system.observer_bus().subscribe(topics::kOrderAnswer, [this](const msg::OrderAnswer& answer) {
      answers[answer.order_number()] = answer.result();
    });
  }
  OrderNumber send(msg::OrderKind kind, RobotId robot, ClientId client, std::vector<Goal> goals = {}) {
    number = std::max(number + 1, static_cast<OrderNumber>(to_ns(system.now())));
    system.send({kind, robot, client, number, std::move(goals)});
    return number;
  }
  OrderNumber draw(std::uint32_t zone_number, const Zone& zone, ClientId client = kClient) {
    Order order{msg::OrderKind::ORDER_ZONE, kAllRobots, client};
    order.number = number = std::max(number + 1, static_cast<OrderNumber>(to_ns(system.now())));
    order.zone_number = zone_number;
    order.zone = zone;
    system.send(order);
    return number;
  }
  void erase(std::uint32_t zone_number, ClientId client = kClient) {
    Order order{msg::OrderKind::ORDER_REMOVE_ZONE, kAllRobots, client};
    order.number = number = std::max(number + 1, static_cast<OrderNumber>(to_ns(system.now())));
    order.zone_number = zone_number;
    system.send(order);
  }
  /// Cuts the links between two processes, in both directions, or heals them.
  void cut(const std::string& a, const std::string& b, bool is_cut = true) {
    cut_one_way(a, b, is_cut);
    cut_one_way(b, a, is_cut);
  }
  void cut_one_way(const std::string& from, const std::string& to, bool is_cut = true) {
    LinkQuality quality;
    quality.is_cut = is_cut;
    system.set_link(from, to, quality);
  }
  /// Cuts a process off from all others and from the clients, or heals its links.
  void isolate(const std::string& process, bool is_cut = true) {
    for (const std::string& other : system_process_names(scenario))
      if (other != process) cut(process, other, is_cut);
    LinkQuality quality;
    quality.is_cut = is_cut;
    system.set_client_link(process, quality);
  }
  /// Kills all processes except the simulator and vision simultaneously, and restarts them.
  void restart_everything() {
    const auto names = system_process_names(scenario);
    for (const std::string& process : names)
      if (process != "simulator" && process != "vision") system.kill(process);
    for (const std::string& process : names) system.restart(process);
  }
  template <typename Condition>
  bool run_until(Duration limit, Condition condition) {
    const Time end = system.now() + limit;
    while (!condition() && system.now() < end) system.run_for(std::chrono::milliseconds(5));
    return condition();
  }
  double max_speed_mps() {
    double max_mps = 0;
    for (const RobotProgress& row : system.metrics().progress()) max_mps = std::max(max_mps, row.speed_mps);
    return max_mps;
  }
  void require_safe() {
    const Report report = system.metrics().report();
    REQUIRE(report.contacts == 0);
    REQUIRE(report.firmware_violations == 0);
    for (const Violation& violation : report.audit->first) UNSCOPED_INFO(to_line(violation));
    REQUIRE(report.audit->violations == 0);
  }
};

}  // namespace sidestep
