// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/agent.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "common/config/scenario_loader.hpp"
#include "common/messaging/codec.hpp"

using namespace sidestep;

namespace {

constexpr Incarnation kSelf = 1000;
constexpr double kCycle_s = 1.0 / 60;

Time at_s(double seconds) { return Time{} + from_seconds(seconds); }

Scenario two_goals() {
  return parse_scenario(
      "field: {length_m: 6, width_m: 4}\nrobots:\n"
      "  - {id: 3, team: blue, start_m: [0, 0], goals_m: [[1, 0], [1, 1, 1.5]]}\n",
      "two-goals.yaml");
}

struct Driven {
  Scenario scenario = two_goals();
  Agent agent{scenario, 3, kSelf, std::make_shared<PlanningScratch>(scenario)};

  Driven() {
    report({0, 0}, 0.5);
    msg::CoordinatorState state;
    state.epoch(7);
    state.coordinator_mode(msg::COORDINATOR_GRANTING);
    agent.on_coordinator_state(state, at_s(0.6));
    (void)agent.negotiation().registration();
  }
  /// The robot stands there.
  void report(const Vec2& place, double at) {
    msg::Feedback feedback;
    feedback.robot(3);
    feedback.obeyed_incarnation(kSelf);
    feedback.obeyed_epoch(7);
    feedback.at_ns(to_ns(at_s(at)));
    feedback.executing(encode(Version{3, 0, 0, 0, Trajectory::resting(at_s(0), place)}));
    feedback.x_m(place.x());
    feedback.y_m(place.y());
    agent.on_feedback(feedback);
  }
  void see(double x, double seen_at, double now, RobotId robot = 3) {
    msg::WorldState world;
    msg::TrackedRobot& seen = world.robots().emplace_back();
    seen.robot(robot);
    seen.seen_at_ns(to_ns(at_s(seen_at)));
    seen.seen_x_m(x);
    agent.on_world(world, at_s(now));
  }
  /// As see(), with somebody who moves without asking.
  void see_obstacle(double x, double y, double seen_at, double now) {
    msg::WorldState world;
    msg::TrackedRobot& seen = world.robots().emplace_back();
    seen.robot(3);
    seen.seen_at_ns(to_ns(at_s(seen_at)));
    world.obstacle_count(1);
    world.obstacles()[0].seen_at_ns(to_ns(at_s(seen_at)));
    world.obstacles()[0].x_m(x);
    world.obstacles()[0].y_m(y);
    world.obstacles()[0].radius_m(0.09);
    agent.on_world(world, at_s(now));
  }
  bool plans(double now) { return agent.plan(at_s(now), at_s(now + kCycle_s)).has_value(); }
};

}  // namespace

TEST_CASE("an agent plans towards its goal as long as vision sees its robot") {
  Driven d;
  CHECK_FALSE(d.plans(0.6));
  d.see(0, 0.6, 0.61);
  const auto query = d.agent.plan(at_s(0.62), at_s(0.62 + kCycle_s));
  REQUIRE(query);
  CHECK(query->desired_mps2.x() > 2);
  CHECK(query->start == at_s(0.62 + kCycle_s));
  CHECK(d.plans(0.85));
  CHECK_FALSE(d.plans(0.95));
  d.see(0, 0.94, 0.95);
  CHECK(d.plans(0.95));
}

TEST_CASE("sights that cannot be are dropped, and later true ones still count") {
  Driven d;
  d.see(std::numeric_limits<double>::quiet_NaN(), 0.6, 0.61);
  CHECK_FALSE(d.plans(0.62));
  d.see(0, 1e6, 0.61);
  CHECK_FALSE(d.plans(0.62));
  d.see(0, 0.6, 0.61, 4);
  CHECK_FALSE(d.plans(0.62));
  d.see(0, 0.61, 0.62);
  CHECK(d.plans(0.63));
  CHECK(d.agent.status(at_s(1)).invalid() == 2);
}

TEST_CASE("a sight is forwarded to the robot once") {
  Driven d;
  d.see(0.001, 0.6, 0.61);
  const auto first = d.agent.command(at_s(1)), second = d.agent.command(at_s(1));
  CHECK(first.has_fix());
  CHECK(first.fix().x_m() == 0.001);
  CHECK_FALSE(first.has_version());
  CHECK_FALSE(second.has_fix());
}

TEST_CASE("goals are visited in order, and the robot turns to a goal's heading") {
  Driven d;
  CHECK(d.agent.status(at_s(1)).goal_index() == 0);
  CHECK(d.agent.status(at_s(1)).distance_to_go_m() == Approx(1));
  CHECK(d.agent.command(at_s(1)).heading_rad() == 0);
  Agent fresh(d.scenario, 3, kSelf, std::make_shared<PlanningScratch>(d.scenario));
  msg::Feedback at_goal;
  at_goal.robot(3);
  at_goal.obeyed_incarnation(kSelf);
  at_goal.at_ns(to_ns(at_s(2)));
  at_goal.x_m(1);
  at_goal.executing(encode(Version{3, 0, 0, 0, Trajectory::resting(at_s(1), {1, 0})}));
  fresh.on_feedback(at_goal);
  CHECK(fresh.status(at_s(1)).goal_index() == 1);
  CHECK(fresh.status(at_s(1)).distance_to_go_m() == Approx(1));
  CHECK(fresh.command(at_s(1)).heading_rad() == 1.5);
}

TEST_CASE("a robot whose held version ends at its goal has nothing to propose") {
  Scenario scenario = two_goals();
  scenario.robots[0].goals = {{{0, 0}, std::nullopt}};
  Agent agent(scenario, 3, kSelf, std::make_shared<PlanningScratch>(scenario));
  msg::Feedback feedback;
  feedback.robot(3);
  feedback.obeyed_incarnation(kSelf);
  feedback.at_ns(to_ns(at_s(0.5)));
  feedback.executing(encode(Version{3, 0, 0, 0, Trajectory::resting(at_s(0), {0, 0})}));
  agent.on_feedback(feedback);
  msg::CoordinatorState state;
  state.epoch(7);
  state.coordinator_mode(msg::COORDINATOR_GRANTING);
  agent.on_coordinator_state(state, at_s(0.6));
  (void)agent.negotiation().registration();
  msg::WorldState world;
  world.robots().emplace_back().robot(3);
  world.robots()[0].seen_at_ns(to_ns(at_s(0.6)));
  agent.on_world(world, at_s(0.61));
  CHECK_FALSE(agent.plan(at_s(0.62), at_s(0.64)));
  CHECK(agent.status(at_s(1)).agent_state() == msg::AGENT_ARRIVED);
}

TEST_CASE(
    "nothing is proposed while somebody who moves without asking is too near, and it goes on afterwards") {
  Driven d;
  d.see_obstacle(0.25, 0, 0.6, 0.61);
  auto query = d.agent.plan(at_s(0.62), at_s(0.62 + kCycle_s));
  REQUIRE(query);
  CHECK_FALSE(d.agent.search(*query, at_s(0.62)));
  // It has gone away, to where it is in nobody's way.
  d.see_obstacle(0, 1.8, 0.7, 0.71);
  query = d.agent.plan(at_s(0.72), at_s(0.72 + kCycle_s));
  REQUIRE(query);
  CHECK(d.agent.search(*query, at_s(0.72)));
}

TEST_CASE("a robot's way leads round where somebody is who moves without asking") {
  Driven d;
  d.see_obstacle(0.6, 0.02, 0.6, 0.61);
  const auto query = d.agent.plan(at_s(0.62), at_s(0.62 + kCycle_s));
  REQUIRE(query);
  CHECK(std::abs(query->desired_mps2.y()) > 1);
  d.see_obstacle(0, 1.8, 0.7, 0.71);
  const auto straight = d.agent.plan(at_s(0.72), at_s(0.72 + kCycle_s));
  REQUIRE(straight);
  CHECK(straight->desired_mps2.x() > 2);
}
