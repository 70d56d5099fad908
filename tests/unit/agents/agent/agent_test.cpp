// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/agent.hpp"

#include "common/config/scenario_loader.hpp"
#include "common/protocol/obstacle_bounds.hpp"
#include "tests/catch.hpp"
#include "tests/drops.hpp"

namespace sidestep::agent_test {

constexpr Incarnation kSelf = 1000;
constexpr double kCycle_s = 1.0 / 60;
constexpr double kUnlimited_mps = std::numeric_limits<double>::infinity();
constexpr Duration kNoLag{0};

Time at_s(double seconds) { return Time{} + from_seconds(seconds); }

Scenario two_goals() {
  return parse_scenario(
      "field: {length_m: 6, width_m: 4}\nrobots:\n"
      "  - {id: 3, team: blue, start_m: [0, 0], goals_m: [[1, 0], [1, 1, 1.5]]}\n",
      "two-goals.yaml");
}

/// The report of a robot at rest.
RobotReport resting_at(const Vec2& position, double at, Epoch epoch = 7) {
  RobotReport robot_report;
  robot_report.robot = 3;
  robot_report.obeyed_incarnation = kSelf;
  robot_report.obeyed_epoch = epoch;
  robot_report.valid_at = at_s(at);
  robot_report.executing = {3, 0, 0, 0, Trajectory::resting(at_s(0), position)};
  robot_report.estimate.position_m = position;
  return robot_report;
}

/// A coordinator's complete memory, which contains only the scenario's order for the robot.
std::shared_ptr<OrderPage> scenario_orders() {
  const RememberedOrder order{{msg::OrderKind::ORDER_GO, 3, static_cast<ClientId>(Sender::kScenario), 1}};
  return std::make_shared<OrderPage>(
      OrderPage{static_cast<std::uint32_t>(Sender::kCoordinator), true, 0, 1, {order}});
}

/// Tells the agent that the coordinator grants, and registers the agent.
void become_ready(Agent& agent, double now = 0.6, double watched_until = 0) {
  CoordinatorHeartbeat heartbeat;
  heartbeat.epoch = 7;
  heartbeat.mode = msg::CoordinatorMode::COORDINATOR_GRANTING;
  heartbeat.watched_until = at_s(watched_until);
  agent.on_coordinator_state(heartbeat, at_s(now));
  agent.on_orders(scenario_orders());
  (void)agent.registration();
}

WorldObservations observation(double x, double observed_at) {
  WorldObservations world;
  world.valid_at = at_s(observed_at);
  world.self = PoseFix{at_s(observed_at), {x, 0}, 0};
  world.self_m = {x, 0};
  return world;
}

/// A list without obstacles.
ObstacleObservations empty_list(double valid_at, double complete_within_m = kCompleteEverywhere_m) {
  return {0, at_s(valid_at), complete_within_m, {}};
}

struct DrivenAgent {
  Scenario scenario = two_goals();
  Agent agent;

  DrivenAgent() : agent(scenario, 3, kSelf, std::make_shared<PlanningScratch>(scenario)) {
    agent.on_robot_report(resting_at({0, 0}, 0.5));
    become_ready(agent);
  }
  /// Delivers a world state without an obstacle list. The coordinator also hears vision.
  void observe_self(double x, double observed_at, double now) {
    CoordinatorHeartbeat heartbeat;
    heartbeat.epoch = 7;
    heartbeat.mode = msg::CoordinatorMode::COORDINATOR_GRANTING;
    heartbeat.watched_until = at_s(now);
    agent.on_coordinator_state(heartbeat, at_s(now));
    agent.on_world_state(observation(x, observed_at), at_s(now));
  }
  void observe(double x, double observed_at, double now) {
    observe_self(x, observed_at, now);
    agent.on_obstacles(empty_list(observed_at), at_s(now));
  }
  /// Like observe(), with a moving obstacle.
  void observe_obstacle(double x, double y, double observed_at, double now) {
    observe_self(0, observed_at, now);
    const ObservedObstacle obstacle{0, at_s(observed_at), {x, y}, 0.09, 0};
    ObstacleObservations list = empty_list(observed_at);
    list.obstacles = {&obstacle, 1};
    agent.on_obstacles(list, at_s(now));
  }
  bool plans(double now) {
    return agent.plan(at_s(now), at_s(now + kCycle_s), kUnlimited_mps, kNoLag).has_value();
  }
};

TEST_CASE("an agent plans towards its goal while vision observes its robot") {
  DrivenAgent d;
  CHECK_FALSE(d.plans(0.6));
  d.observe(0, 0.6, 0.61);
  const auto plan = d.agent.plan(at_s(0.62), at_s(0.62 + kCycle_s), kUnlimited_mps, kNoLag);
  REQUIRE(plan);
  CHECK(plan->query.desired_mps2.x() > 2);
  CHECK(plan->query.start == at_s(0.62 + kCycle_s));
  CHECK(d.plans(0.85));
  CHECK_FALSE(d.plans(0.95));
  d.observe(0, 0.94, 0.95);
  CHECK(d.plans(0.95));
}

TEST_CASE("a robot that is lifted after its plan has no version from which courses could begin") {
  DrivenAgent d;
  d.observe(0, 0.6, 0.61);
  REQUIRE(d.plans(0.62));
  RobotReport lifted = resting_at({0, 0}, 0.63);
  lifted.is_lifted = true;
  d.agent.on_robot_report(lifted);
  d.agent.plan_courses();
  d.observe(0, 0.64, 0.65);
  CHECK_FALSE(d.plans(0.66));
}

TEST_CASE("a moving obstacle's reach grows with the robot's possible lag") {
  const Duration max_lag = std::chrono::milliseconds(60);
  DrivenAgent d;
  d.observe_obstacle(2, 1, 0.6, 0.61);
  const auto planned = [&](Duration lag) {
    return d.agent.plan(at_s(0.62), at_s(0.62 + kCycle_s), kUnlimited_mps, lag)->query;
  };
  const SearchQuery on_time = planned(Duration{0});
  REQUIRE(on_time.moving.size() == 1);
  const double reach_m = on_time.moving[0].reach_m(at_s(1)), speed_mps = on_time.moving[0].speed_mps;
  const SearchQuery late = planned(max_lag);
  REQUIRE(late.moving.size() == 1);
  CHECK(late.moving[0].reach_m(at_s(1)) == Approx(reach_m + speed_mps * to_seconds(max_lag)));
}

TEST_CASE("an agent plans only while the coordinator hears vision") {
  DrivenAgent d;
  d.observe(0, 0.6, 0.61);
  CHECK(d.plans(0.62));
  for (const double at : {0.8, 1.0, 1.2}) {
    d.agent.on_world_state(observation(0, at), at_s(at));
    d.agent.on_obstacles(empty_list(at), at_s(at));
    become_ready(d.agent, at, 0.61);
  }
  CHECK(d.plans(1.2));
  CHECK_FALSE(d.plans(1.22));
  become_ready(d.agent, 1.2, 1.19);
  CHECK(d.plans(1.22));
}

TEST_CASE("a robot that vision has lost is not driven, even if vision sees other robots") {
  DrivenAgent d;
  d.observe(0, 0.6, 0.61);
  CHECK(d.plans(0.62));
  for (const double at : {0.8, 0.95}) {
    WorldObservations world = observation(0, at);
    world.self.reset();
    d.agent.on_world_state(world, at_s(at));
    d.agent.on_obstacles(empty_list(at), at_s(at));
    become_ready(d.agent, at, at);
  }
  CHECK_FALSE(d.plans(0.95));
}

TEST_CASE("a robot whose position error is large does not drive") {
  const auto desired_mps2 = [](double position_error_rms_m) {
    DrivenAgent d;
    RobotReport robot_report = resting_at({0, 0}, 0.55);
    robot_report.uncertainty = {position_error_rms_m, 0.01};
    d.agent.on_robot_report(robot_report);
    d.observe(0, 0.6, 0.61);
    const auto plan = d.agent.plan(at_s(0.62), at_s(0.62 + kCycle_s), kUnlimited_mps, kNoLag);
    return plan ? plan->query.desired_mps2.norm() : 0;
  };
  CHECK(desired_mps2(0.0002) > 2);
  CHECK(desired_mps2(0.002) == 0);
}

TEST_CASE("an agent plans only while it receives obstacle lists") {
  DrivenAgent d;
  d.observe_self(0, 0.6, 0.61);
  CHECK_FALSE(d.plans(0.62));
  d.agent.on_obstacles(empty_list(0.6), at_s(0.61));
  CHECK(d.plans(0.62));
  d.observe_self(0, 0.85, 0.86);
  CHECK(d.plans(0.89));
  CHECK_FALSE(d.plans(0.95));
  // An incomplete list is usable together with the world state of the same time.
  d.agent.on_obstacles(empty_list(0.92, 1), at_s(0.93));
  CHECK_FALSE(d.plans(0.95));
  d.observe_self(0, 0.92, 0.94);
  CHECK(d.plans(0.95));
}

TEST_CASE("a robot does not drive where an unlisted obstacle could reach it") {
  const auto drives = [](double complete_within_m) {
    DrivenAgent d;
    d.observe_self(0, 0.6, 0.61);
    d.agent.on_obstacles(empty_list(0.6, complete_within_m), at_s(0.61));
    const auto plan = d.agent.plan(at_s(0.62), at_s(0.62 + kCycle_s), kUnlimited_mps, kNoLag);
    REQUIRE(plan);
    CHECK(plan->query.seen.is_everywhere() == (complete_within_m == kCompleteEverywhere_m));
    return d.agent.search(*plan, at_s(0.62)).has_value();
  };
  CHECK(drives(kCompleteEverywhere_m));
  CHECK(drives(2));
  CHECK_FALSE(drives(0.1));  // about the robot's radius plus its margin
  CHECK_FALSE(drives(0));
}

TEST_CASE("an inflated robot waits until it is at rest and vision agrees with its own estimate") {
  DrivenAgent d;
  RobotReport displaced = resting_at({0, 0}, 1);
  displaced.executing.number = 50;
  displaced.executing.inflation_m = 0.05;
  displaced.executing.trajectory = Trajectory::resting(at_s(0.9), {0, 0});
  displaced.is_off_reference = true;
  d.agent.on_robot_report(displaced);
  const auto rest = [&](double now) { return d.agent.propose_rest_version(at_s(now), at_s(now + kCycle_s)); };
  // If the robot drove on, the inflation would remain, and the robot might never fit through narrow places.
  d.observe(0, 0.85, 1.01);  // captured before the robot rested
  CHECK_FALSE(rest(1.02));
  CHECK_FALSE(d.plans(1.02));
  d.observe(0.04, 1.02, 1.03);  // the robot has not received this observation yet
  CHECK_FALSE(rest(1.04));
  displaced.valid_at = at_s(1.05);
  displaced.estimate.position_m = {0.039, 0};
  d.agent.on_robot_report(displaced);
  CHECK_FALSE(d.plans(1.06));
  const auto proposal = rest(1.06);
  REQUIRE(proposal);
  REQUIRE(proposal->candidate_count == 1);
  CHECK(proposal->candidates[0]->base == 50);
  CHECK(proposal->candidates[0]->inflation_m == 0);
  CHECK(proposal->candidates[0]->trajectory.phases().empty());
  // A proposal without a verdict would delay the end of the agent.
  d.agent.stop();
  CHECK_FALSE(rest(1.08));
}

TEST_CASE("the inflation of a robot without an order ends too, but a held robot proposes nothing") {
  const bool is_held = GENERATE(false, true);
  CAPTURE(is_held);
  Scenario scenario = two_goals();
  scenario.robots.front().goals.clear();
  Agent agent(scenario, 3, kSelf, std::make_shared<PlanningScratch>(scenario));
  agent.on_robot_report(resting_at({0, 0}, 0.5));
  become_ready(agent, 0.6, 0.6);
  if (is_held) {
    const RememberedOrder hold{{msg::OrderKind::ORDER_HOLD, 3, static_cast<ClientId>(Sender::kOperator), 2}};
    agent.on_orders(std::make_shared<OrderPage>(
        OrderPage{static_cast<std::uint32_t>(Sender::kCoordinator), true, 0, 1, {hold}}));
  }
  RobotReport displaced = resting_at({0, 0}, 0.7);
  displaced.executing = {3, 0, 50, 0, Trajectory::resting(at_s(0.65), {0, 0}), 1.0};
  displaced.is_off_reference = true;
  agent.on_robot_report(displaced);
  agent.on_world_state(observation(0, 0.7), at_s(0.71));
  agent.on_obstacles(empty_list(0.7), at_s(0.71));
  CHECK(agent.propose_rest_version(at_s(0.72), at_s(0.72 + kCycle_s)).has_value() == !is_held);
}

TEST_CASE("a robot that vision's latest observations show elsewhere is not driven until they agree again") {
  DrivenAgent d;
  d.observe(0, 0.6, 0.61);
  CHECK(d.plans(0.62));
  WorldObservations doubtful = observation(0, 0.6);
  doubtful.is_self_seen_elsewhere = true;
  d.agent.on_world_state(doubtful, at_s(0.63));
  CHECK_FALSE(d.plans(0.64));
  CHECK(d.agent.wait_reason(at_s(0.64)) == WaitReason::kSeenElsewhere);
  d.agent.on_world_state(observation(0, 0.5), at_s(0.64));  // overtaken
  CHECK_FALSE(d.plans(0.64));
  d.agent.on_world_state(observation(0, 0.6), at_s(0.64));  // likewise, with the same observation
  CHECK_FALSE(d.plans(0.64));
  d.observe(0, 0.65, 0.66);
  CHECK(d.plans(0.67));
}

TEST_CASE("a robot beside a stranger creeps away, and its order's status names the stranger") {
  DrivenAgent d;
  int proposals = 0;
  for (int cycle = 0; cycle < 20; ++cycle) {
    const double now = 0.62 + cycle * kCycle_s;
    d.agent.close_cycle(at_s(now));
    d.agent.on_robot_report(resting_at({0, 0}, now - 0.01));
    d.observe_obstacle(0.25, 0, now - 0.04, now - 0.01);
    const auto plan = d.agent.plan(at_s(now), at_s(now + kCycle_s), kUnlimited_mps, kNoLag);
    REQUIRE(plan);
    const auto proposal = d.agent.search(*plan, at_s(now));
    if (!proposal) continue;
    ++proposals;
    for (std::size_t i = 0; i < proposal->candidate_count; ++i) {
      const Trajectory& motion = proposal->candidates[i]->trajectory;
      CHECK(motion.state_at(motion.start() + motion.phases().front().duration).velocity_mps.norm() <= 0.03);
      CHECK(motion.rest_position_m().x() < 0);
    }
  }
  CHECK(proposals > 0);
  const OrderReport report = d.agent.order_report();
  REQUIRE(report.blockage);
  CHECK(report.blockage->reason == msg::BlockReason::BLOCK_STRANGER);
  CHECK(report.blockage->blocker_speed_mps == 1.5);
  CHECK_FALSE(d.agent.remaining_s());
}

TEST_CASE("each own stop of the robot counts once as a loss of its reference") {
  DrivenAgent d;
  RobotReport stopped = resting_at({0, 0}, 1);
  const auto losses_after = [&](VersionNumber number, bool is_off_reference) {
    stopped.executing.number = number;
    stopped.is_off_reference = is_off_reference;
    d.agent.on_robot_report(stopped);
    return d.agent.status(at_s(1)).reference_losses();
  };
  CHECK(losses_after(50, false) == 0);
  CHECK(losses_after(51, true) == 1);
  CHECK(losses_after(51, true) == 1);
  CHECK(losses_after(52, false) == 1);
  CHECK(losses_after(53, true) == 2);
}

TEST_CASE("an observation from the future is dropped and counted, and later valid observations are used") {
  DrivenAgent d;
  d.agent.on_obstacles(empty_list(0.6), at_s(0.61));
  d.observe_self(0, 1e6, 0.61);
  WorldObservations latest = observation(0, 0);
  latest.self->captured_at = Time::max();
  d.agent.on_world_state(latest, at_s(0.61));
  CHECK_FALSE(d.plans(0.62));
  CHECK(drops_of(d.agent).total(DropReason::kFutureObservation) == 2);
  d.agent.on_world_state(WorldObservations(), at_s(0.61));
  latest.self->captured_at = Time::min();
  d.agent.on_world_state(latest, at_s(0.61));
  CHECK_FALSE(d.plans(0.62));
  d.observe(0, 0.61, 0.62);
  CHECK(d.plans(0.63));
  CHECK(drops_of(d.agent).total(DropReason::kFutureObservation) == 2);
}

TEST_CASE("an incomplete list is not used if the observation of the same time was dropped") {
  DrivenAgent d;
  d.observe(0, 0.6, 0.61);
  REQUIRE(d.plans(0.62));
  WorldObservations world = observation(0, 0.9);
  world.self->captured_at = at_s(2);  // from the future
  d.observe_self(0, 0.89, 0.9);
  d.agent.on_world_state(world, at_s(0.91));
  d.agent.on_obstacles(empty_list(0.9, 2), at_s(0.91));
  CHECK_FALSE(d.plans(0.92));
  d.agent.on_world_state(observation(0, 0.9), at_s(0.91));
  CHECK(d.plans(0.92));
}

TEST_CASE("until the robot's clock is known, observations are forwarded but not used") {
  DrivenAgent d;
  d.agent.on_obstacles(empty_list(0.6), at_s(0.61));
  d.observe_self(0, 0.5, 0.61);
  d.agent.on_world_state(observation(0, 3599), at_s(0.61), false);
  const Command command = d.agent.command(at_s(0.62));
  REQUIRE(command.fix);
  CHECK(command.fix->captured_at == at_s(3599));
  d.agent.on_world_state(observation(0, 3601), at_s(0.61), false);
  CHECK_FALSE(d.agent.command(at_s(0.62)).fix);
  d.observe(0, 0.62, 0.63);
  CHECK(d.plans(0.63));
  CHECK(drops_of(d.agent).total(DropReason::kFutureObservation) == 1);
}

TEST_CASE("the hidden space has the scan's capture time and allows for the error of the scan's pose") {
  Scenario scenario = two_goals();
  scenario.laser.emplace();
  Agent agent(scenario, 3, kSelf, std::make_shared<PlanningScratch>(scenario));
  agent.on_robot_report(resting_at({0, 0}, 0.5));
  become_ready(agent, 0.6, 0.6);
  agent.on_world_state(observation(0, 0.6), at_s(0.61));
  // Unknown objects surround the robot.
  const std::vector<float> ranges_m(static_cast<std::size_t>(scenario.laser->settings.beams), 1.5F);
  agent.on_scan({{0, 0}, 0, at_s(0.55), ranges_m}, at_s(0.61));
  const auto plan = agent.plan(at_s(0.62), at_s(0.62 + kCycle_s), kUnlimited_mps, kNoLag);
  REQUIRE(plan);
  const HiddenSpace& hidden = plan->query.hidden;
  CHECK(hidden.observed_at == at_s(0.55));
  CHECK(hidden.observed_from_m == Vec2(0, 0));
  CHECK(hidden.speed_mps == scenario.max_opponent_speed_mps);
  CHECK(hidden.heading_error_rad == 0.02);
  // In addition to the range error, the frontier may be rotated about the robot, and people may have
  // approached since the scan.
  const double frontier_m = 1.5 - scenario.laser->range_error_m;
  CHECK(hidden.distance_m({0.5, 0}, at_s(0.75)) ==
        Approx(frontier_m - 0.5 - 0.2 * scenario.max_opponent_speed_mps - 0.5 * 0.02).margin(0.01));
}

TEST_CASE("each observation is forwarded to the robot once") {
  DrivenAgent d;
  d.observe(0.001, 0.6, 0.61);
  const auto first = d.agent.command(at_s(1)), second = d.agent.command(at_s(1));
  REQUIRE(first.fix);
  CHECK(first.fix->position_m == Vec2(0.001, 0));
  CHECK(first.fix->captured_at == at_s(0.6));
  CHECK_FALSE(first.version);
  CHECK_FALSE(second.fix);
  // Vision repeats the last observation of a robot that it does not see.
  d.observe(0.001, 0.6, 0.62);
  CHECK_FALSE(d.agent.command(at_s(1)).fix);
}

TEST_CASE("goals are visited in order, and the robot turns to a goal's heading") {
  DrivenAgent d;
  CHECK(d.agent.status(at_s(1)).goal_index() == 0);
  CHECK(d.agent.status(at_s(1)).distance_to_go_m() == Approx(1));
  CHECK(d.agent.command(at_s(1)).desired_heading_rad == 0);
  Agent fresh(d.scenario, 3, kSelf, std::make_shared<PlanningScratch>(d.scenario));
  fresh.on_orders(scenario_orders());
  fresh.on_robot_report(resting_at({1, 0}, 2, 0));
  CHECK(fresh.status(at_s(1)).goal_index() == 1);
  CHECK(fresh.status(at_s(1)).distance_to_go_m() == Approx(1));
  CHECK(fresh.command(at_s(1)).desired_heading_rad == 1.5);
}

TEST_CASE("a robot whose current version ends at its goal proposes nothing") {
  Scenario scenario = two_goals();
  scenario.robots[0].goals = {{{0, 0}, std::nullopt}};
  Agent agent(scenario, 3, kSelf, std::make_shared<PlanningScratch>(scenario));
  agent.on_orders(scenario_orders());
  agent.on_robot_report(resting_at({0, 0}, 0.5, 0));
  become_ready(agent);
  agent.on_world_state(observation(0, 0.6), at_s(0.61));
  agent.on_obstacles(empty_list(0.6), at_s(0.61));
  CHECK_FALSE(agent.plan(at_s(0.62), at_s(0.64), kUnlimited_mps, kNoLag));
  CHECK(agent.status(at_s(1)).agent_state() == msg::AgentState::AGENT_ARRIVED);
}

TEST_CASE("the search finds no candidate while a moving obstacle is too near, except for creeping away") {
  DrivenAgent d;
  d.observe_obstacle(0.25, 0, 0.6, 0.61);
  auto plan = d.agent.plan(at_s(0.62), at_s(0.62 + kCycle_s), kUnlimited_mps, kNoLag);
  REQUIRE(plan);
  CHECK(d.agent.search(*plan, at_s(0.62)));
  plan->query.creep_mps = 0;
  CHECK_FALSE(d.agent.search(*plan, at_s(0.62)));
  // The obstacle has moved out of the way.
  d.observe_obstacle(0, 1.8, 0.7, 0.71);
  plan = d.agent.plan(at_s(0.72), at_s(0.72 + kCycle_s), kUnlimited_mps, kNoLag);
  REQUIRE(plan);
  CHECK(d.agent.search(*plan, at_s(0.72)));
}

TEST_CASE("a robot's route leads around a moving obstacle") {
  DrivenAgent d;
  d.observe_obstacle(0.6, 0.02, 0.6, 0.61);
  const auto plan = d.agent.plan(at_s(0.62), at_s(0.62 + kCycle_s), kUnlimited_mps, kNoLag);
  REQUIRE(plan);
  CHECK(std::abs(plan->query.desired_mps2.y()) > 1);
  d.observe_obstacle(0, 1.8, 0.7, 0.71);
  const auto straight = d.agent.plan(at_s(0.72), at_s(0.72 + kCycle_s), kUnlimited_mps, kNoLag);
  REQUIRE(straight);
  CHECK(straight->query.desired_mps2.x() > 2);
}

}  // namespace sidestep::agent_test
