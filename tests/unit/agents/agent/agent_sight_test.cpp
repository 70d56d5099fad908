// SPDX-License-Identifier: Apache-2.0
// How a robot with a laser drives near places where a person may step out.
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "agents/agent/agent.hpp"
#include "common/config/scenario_loader.hpp"
#include "common/map/laser_scanner.hpp"
#include "tests/catch.hpp"

namespace sidestep::agent_sight_test {

constexpr Incarnation kSelf = 1000;
constexpr double kCycle_s = 1.0 / 60;
constexpr double kUnlimited_mps = std::numeric_limits<double>::infinity();
constexpr Duration kNoLag{0};

Time at_s(double seconds) { return Time{} + from_seconds(seconds); }

Scenario with_laser() {
  Scenario scenario = parse_scenario(
      "field: {length_m: 20, width_m: 20}\nrobots:\n"
      "  - {id: 3, team: blue, start_m: [0, 0], goals_m: [[4, 0]]}\n",
      "laser.yaml");
  scenario.laser.emplace();
  scenario.max_opponent_speed_mps = 1;
  return scenario;
}

/// A robot at the origin, at rest or driving along x, with an unknown wall in front of it. The space behind
/// the wall is hidden.
///
///      |
///   o  |  wall_m away, in the direction `bearing_rad`
///      |
struct BeforeWall {
  Scenario scenario = with_laser();
  Agent agent{scenario, 3, kSelf, std::make_shared<PlanningScratch>(scenario)};
  Vec2 towards;
  std::vector<float> ranges_m;

  BeforeWall(double wall_m, double bearing_rad, double speed_mps = 0)
      : towards(std::cos(bearing_rad), std::sin(bearing_rad)) {
    RobotReport robot_report;
    robot_report.robot = 3;
    robot_report.obeyed_incarnation = kSelf;
    robot_report.obeyed_epoch = 7;
    robot_report.valid_at = at_s(0.5);
    Trajectory trajectory(at_s(0.5), {{-speed_mps * (0.11 + kCycle_s), 0}, {speed_mps, 0}});
    trajectory.append(from_seconds(1), {0, 0});
    trajectory.append(from_seconds(speed_mps / 3), {-3, 0});
    robot_report.executing = {3, 0, 0, 0, trajectory};
    robot_report.estimate = trajectory.at_start();
    agent.on_robot_report(robot_report);
    CoordinatorHeartbeat heartbeat;
    heartbeat.epoch = 7;
    heartbeat.mode = msg::CoordinatorMode::COORDINATOR_GRANTING;
    heartbeat.watched_until = at_s(0.6);
    agent.on_coordinator_state(heartbeat, at_s(0.6));
    const RememberedOrder order{{msg::OrderKind::ORDER_GO, 3, static_cast<ClientId>(Sender::kScenario), 1}};
    agent.on_orders(std::make_shared<OrderPage>(
        OrderPage{static_cast<std::uint32_t>(Sender::kCoordinator), true, 0, 1, {order}}));
    (void)agent.registration();
    WorldObservations world;
    world.valid_at = at_s(0.6);
    world.self = PoseFix{at_s(0.6), {0, 0}, 0};
    agent.on_world_state(world, at_s(0.6));
    const LaserScanner scanner(scenario.laser->settings);
    for (int beam = 0; beam < scenario.laser->settings.beams; ++beam) {
      const double along = std::cos(scanner.beam_angle_rad(beam) - bearing_rad);
      const double range_m = along > 0.2 ? wall_m / along : INFINITY;
      ranges_m.push_back(static_cast<float>(range_m < 8 ? range_m : INFINITY));
    }
    scan(0.6, 0.6);
  }
  /// Receives a scan of the wall, taken at one time by the robot's clock and received at another.
  void scan(double captured_at_s, double now_s) {
    agent.on_scan({{0, 0}, 0, at_s(captured_at_s), ranges_m}, at_s(now_s));
  }
  bool may_drive() const { return agent.wait_reason(at_s(0.61)) == WaitReason::kNone; }
  Vec2 desired_mps2() {
    const auto plan = agent.plan(at_s(0.61), at_s(0.61 + kCycle_s), kUnlimited_mps, kNoLag);
    REQUIRE(plan);
    return plan->query.desired_mps2;
  }
};

TEST_CASE("if no speed is safe from hidden people, the robot creeps away from the nearest hidden space") {
  for (double bearing_rad = -3; bearing_rad <= 3; bearing_rad += 0.5) {
    CAPTURE(bearing_rad);
    BeforeWall robot(0.17, bearing_rad);
    const Vec2 desired_mps2 = robot.desired_mps2();
    REQUIRE(desired_mps2.norm() > 0);
    CHECK(desired_mps2.normalized().dot(-robot.towards) > 0.99);
  }
}

TEST_CASE("a scan from before the robot's clock was set back is not used, and the next scan replaces it") {
  const double back_s = GENERATE(0.005, 0.2, 5.0, 3000.0);
  CAPTURE(back_s);
  BeforeWall robot(3, 0);
  REQUIRE(robot.may_drive());
  robot.scan(0.61 + back_s, 0.61 + back_s);
  CHECK_FALSE(robot.may_drive());
  robot.scan(0.605, 0.61);
  CHECK(robot.may_drive());
  CHECK(robot.desired_mps2().x() > 0);
}

TEST_CASE("a robot drives on for another cycle only if it can still stop before a hidden person reaches it") {
  const double speed_mps = GENERATE(0.5, 1.0, 1.5);
  CAPTURE(speed_mps);
  const Scenario scenario = with_laser();
  const MotionLimits& limits = scenario.limits;
  const double last_mps = speed_mps + limits.acceleration_mps2 * kCycle_s;
  const double driven_m = (speed_mps + last_mps) / 2 * kCycle_s,
               braking_s = last_mps / limits.deceleration_mps2;
  // When the robot begins to accelerate, the scan is one cycle and 10 ms old.
  const double person_m = scenario.max_opponent_speed_mps * (0.01 + 2 * kCycle_s + braking_s);
  const double needed_m = scenario.radius_m + scenario.margin_m + scenario.laser->range_error_m + driven_m +
                          last_mps * braking_s / 2 + person_m;
  CHECK(BeforeWall(needed_m + 0.01, 0, speed_mps).desired_mps2().x() > 0.9 * limits.acceleration_mps2);
  CHECK(BeforeWall(needed_m - 0.01, 0, speed_mps).desired_mps2().x() < 0);
}

}  // namespace sidestep::agent_sight_test
