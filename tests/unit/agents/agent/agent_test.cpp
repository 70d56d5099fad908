// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/agent.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "common/config/scenario_loader.hpp"
#include "common/messaging/codec.hpp"

namespace sidestep::agent_test {

constexpr Incarnation kSelf = 1000;
constexpr double kCycle_s = 1.0 / 60;

Time at_s(double seconds) { return Time{} + from_seconds(seconds); }

Scenario two_goals() {
  return parse_scenario(
      "field: {length_m: 6, width_m: 4}\nrobots:\n"
      "  - {id: 3, team: blue, start_m: [0, 0], goals_m: [[1, 0], [1, 1, 1.5]]}\n",
      "two-goals.yaml");
}

struct DrivenAgent {
  Scenario scenario = two_goals();
  Agent agent;

  explicit DrivenAgent(const PlanningSettings& settings = {})
      : agent(scenario, 3, kSelf, std::make_shared<PlanningScratch>(scenario), settings) {
    report({0, 0}, 0.5);
    msg::CoordinatorState state;
    state.epoch(7);
    state.coordinator_mode(msg::COORDINATOR_GRANTING);
    agent.on_coordinator_state(state, at_s(0.6));
    (void)agent.registration();
  }
  /// Feedback of a robot at rest.
  void report(const Vec2& position, double at) {
    msg::Feedback feedback;
    feedback.robot(3);
    feedback.obeyed_incarnation(kSelf);
    feedback.obeyed_epoch(7);
    feedback.valid_at_ns(to_ns(at_s(at)));
    feedback.executing(encode(Version{3, 0, 0, 0, Trajectory::resting(at_s(0), position)}));
    feedback.x_m(position.x());
    feedback.y_m(position.y());
    agent.on_feedback(feedback);
  }
  void observe(double x, double observed_at, double now, RobotId robot = 3) {
    msg::WorldState world;
    msg::TrackedRobot& observed = world.robots().emplace_back();
    observed.robot(robot);
    observed.observed_at_ns(to_ns(at_s(observed_at)));
    observed.observed_x_m(x);
    agent.on_world(world, at_s(now));
  }
  /// As observe(), with a moving obstacle.
  void observe_obstacle(double x, double y, double observed_at, double now) {
    msg::WorldState world;
    msg::TrackedRobot& observed = world.robots().emplace_back();
    observed.robot(3);
    observed.observed_at_ns(to_ns(at_s(observed_at)));
    world.obstacle_count(1);
    world.obstacles()[0].observed_at_ns(to_ns(at_s(observed_at)));
    world.obstacles()[0].x_m(x);
    world.obstacles()[0].y_m(y);
    world.obstacles()[0].radius_m(0.09);
    agent.on_world(world, at_s(now));
  }
  bool plans(double now) { return agent.plan(at_s(now), at_s(now + kCycle_s)).has_value(); }
};

TEST_CASE("an agent plans towards its goal as long as vision observes its robot") {
  DrivenAgent d;
  CHECK_FALSE(d.plans(0.6));
  d.observe(0, 0.6, 0.61);
  const auto plan = d.agent.plan(at_s(0.62), at_s(0.62 + kCycle_s));
  REQUIRE(plan);
  CHECK(plan->query.desired_mps2.x() > 2);
  CHECK(plan->query.start == at_s(0.62 + kCycle_s));
  CHECK(d.plans(0.85));
  CHECK_FALSE(d.plans(0.95));
  d.observe(0, 0.94, 0.95);
  CHECK(d.plans(0.95));
}

TEST_CASE("planning settings replace the defaults") {
  PlanningSettings settings;
  settings.max_fix_age = from_seconds(0.45);
  DrivenAgent d(settings);
  d.observe(0, 0.6, 0.61);
  CHECK(d.plans(1.04));
  CHECK_FALSE(d.plans(1.06));
}

TEST_CASE("impossible observations are dropped, and later valid ones are still used") {
  DrivenAgent d;
  d.observe(std::numeric_limits<double>::quiet_NaN(), 0.6, 0.61);
  CHECK_FALSE(d.plans(0.62));
  d.observe(0, 1e6, 0.61);
  CHECK_FALSE(d.plans(0.62));
  d.observe(0, 0.6, 0.61, 4);
  CHECK_FALSE(d.plans(0.62));
  d.observe(0, 0.61, 0.62);
  CHECK(d.plans(0.63));
  CHECK(d.agent.status(at_s(1)).invalid() == 2);
}

TEST_CASE("an observation is forwarded to the robot once") {
  DrivenAgent d;
  d.observe(0.001, 0.6, 0.61);
  const auto first = d.agent.command(at_s(1)), second = d.agent.command(at_s(1));
  CHECK(first.has_fix());
  CHECK(first.fix().x_m() == 0.001);
  CHECK_FALSE(first.has_version());
  CHECK_FALSE(second.has_fix());
}

TEST_CASE("goals are visited in order, and the robot turns to a goal's heading") {
  DrivenAgent d;
  CHECK(d.agent.status(at_s(1)).goal_index() == 0);
  CHECK(d.agent.status(at_s(1)).distance_to_go_m() == Approx(1));
  CHECK(d.agent.command(at_s(1)).desired_heading_rad() == 0);
  Agent fresh(d.scenario, 3, kSelf, std::make_shared<PlanningScratch>(d.scenario));
  msg::Feedback at_goal;
  at_goal.robot(3);
  at_goal.obeyed_incarnation(kSelf);
  at_goal.valid_at_ns(to_ns(at_s(2)));
  at_goal.x_m(1);
  at_goal.executing(encode(Version{3, 0, 0, 0, Trajectory::resting(at_s(1), {1, 0})}));
  fresh.on_feedback(at_goal);
  CHECK(fresh.status(at_s(1)).goal_index() == 1);
  CHECK(fresh.status(at_s(1)).distance_to_go_m() == Approx(1));
  CHECK(fresh.command(at_s(1)).desired_heading_rad() == 1.5);
}

TEST_CASE("a robot whose current version ends at its goal proposes nothing") {
  Scenario scenario = two_goals();
  scenario.robots[0].goals = {{{0, 0}, std::nullopt}};
  Agent agent(scenario, 3, kSelf, std::make_shared<PlanningScratch>(scenario));
  msg::Feedback feedback;
  feedback.robot(3);
  feedback.obeyed_incarnation(kSelf);
  feedback.valid_at_ns(to_ns(at_s(0.5)));
  feedback.executing(encode(Version{3, 0, 0, 0, Trajectory::resting(at_s(0), {0, 0})}));
  agent.on_feedback(feedback);
  msg::CoordinatorState state;
  state.epoch(7);
  state.coordinator_mode(msg::COORDINATOR_GRANTING);
  agent.on_coordinator_state(state, at_s(0.6));
  (void)agent.registration();
  msg::WorldState world;
  world.robots().emplace_back().robot(3);
  world.robots()[0].observed_at_ns(to_ns(at_s(0.6)));
  agent.on_world(world, at_s(0.61));
  CHECK_FALSE(agent.plan(at_s(0.62), at_s(0.64)));
  CHECK(agent.status(at_s(1)).agent_state() == msg::AGENT_ARRIVED);
}

TEST_CASE("nothing is proposed while a moving obstacle is too near, and proposals resume afterwards") {
  DrivenAgent d;
  d.observe_obstacle(0.25, 0, 0.6, 0.61);
  auto plan = d.agent.plan(at_s(0.62), at_s(0.62 + kCycle_s));
  REQUIRE(plan);
  CHECK_FALSE(d.agent.search(*plan, at_s(0.62)));
  // The obstacle has moved out of the way.
  d.observe_obstacle(0, 1.8, 0.7, 0.71);
  plan = d.agent.plan(at_s(0.72), at_s(0.72 + kCycle_s));
  REQUIRE(plan);
  CHECK(d.agent.search(*plan, at_s(0.72)));
}

TEST_CASE("a robot's route leads around a moving obstacle") {
  DrivenAgent d;
  d.observe_obstacle(0.6, 0.02, 0.6, 0.61);
  const auto plan = d.agent.plan(at_s(0.62), at_s(0.62 + kCycle_s));
  REQUIRE(plan);
  CHECK(std::abs(plan->query.desired_mps2.y()) > 1);
  d.observe_obstacle(0, 1.8, 0.7, 0.71);
  const auto straight = d.agent.plan(at_s(0.72), at_s(0.72 + kCycle_s));
  REQUIRE(straight);
  CHECK(straight->query.desired_mps2.x() > 2);
}

}  // namespace sidestep::agent_test
