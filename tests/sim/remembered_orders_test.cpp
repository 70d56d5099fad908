// SPDX-License-Identifier: Apache-2.0
// Holds survive partitions and crashes while a process that remembers
// them runs (S-47, S-48), and no robot drives after all processes have restarted.
#include <set>

#include "common/client/order_client.hpp"
#include "common/protocol/process_names.hpp"
#include "common/random/rng.hpp"
#include "tests/catch.hpp"
#include "tests/sim/ordered_system.hpp"

namespace sidestep::remembered_orders_test {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr auto kRemembered = msg::OrderResult::RESULT_REMEMBERED;

/// A system whose robots have driven and now rest.
struct Fleet : OrderedSystem {
  Fleet(int robots, int coordinators, std::uint64_t seed)
      : OrderedSystem(waiting_robots(robots, coordinators), seed) {
    system.run_for(seconds(2));
    const auto first = send(msg::OrderKind::ORDER_GO, 0, kOperator, {{{-1.5, -1.5}}});
    REQUIRE(run_until(seconds(5), [&] { return arrived.contains(first); }));
    system.run_for(seconds(2));
  }
  /// Gives a hold and waits for its confirmation.
  OrderNumber hold(RobotId robot) {
    const auto hold = send(msg::OrderKind::ORDER_HOLD, robot, kClient);
    CHECK(run_until(seconds(4), [&] { return answers.contains(hold); }));
    CHECK(answers[hold] == kRemembered);
    return hold;
  }
  bool moves(Duration duration) {
    return run_until(duration, [&] { return max_speed_mps() > kAtRest_mps; });
  }
  /// Checks that the robot carries out an order to drive only after the hold is lifted.
  void require_held(RobotId robot) {
    send(msg::OrderKind::ORDER_GO, robot, kOtherClient, {{{2, 1}}});
    CHECK_FALSE(moves(seconds(10)));
    CHECK(statuses[robot].is_held());
    // Only the hold stops the robot.
    const auto resume = send(msg::OrderKind::ORDER_RESUME, robot, kClient);
    CHECK(run_until(seconds(3), [&] { return answers.contains(resume); }));
    CHECK(run_until(seconds(5), [&] { return max_speed_mps() > 0.5; }));
    require_safe();
  }
};

// The standby's host is partitioned while a client holds robot 0. Then the host with coordinator 0 and robot
// 0's agent loses power, and the partition heals. The memory of coordinator 1 claims to be complete.
TEST_CASE(
    "a hold survives the death of its coordinator and its robot's agent, even if the standby was "
    "partitioned") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  Fleet run(3, 2, seed);
  run.isolate("coordinator 1");
  run.system.run_for(milliseconds(500));
  run.hold(0);
  run.system.kill("coordinator");
  run.system.kill(agent_process(0));
  run.system.run_for(milliseconds(100));
  run.isolate("coordinator 1", false);
  run.system.restart(agent_process(0));
  run.system.run_for(seconds(5));
  run.require_held(0);
}

// Agent 2 does not hear the coordinator when the robot is put on hold. Agent 1 does not hear the coordinator
// when the coordinator restarts.
TEST_CASE(
    "a hold survives the restart of the only coordinator, even if another agent does not know about the "
    "hold") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  Fleet run(3, 1, seed);
  run.cut("coordinator", agent_process(2));
  run.system.run_for(milliseconds(100));
  run.hold(0);
  run.cut("coordinator", agent_process(1));
  run.cut("coordinator", agent_process(2), false);
  run.system.kill("coordinator");
  run.system.kill(agent_process(0));
  run.system.run_for(milliseconds(100));
  run.system.restart("coordinator");
  run.system.restart(agent_process(0));
  run.system.run_for(seconds(2));
  CHECK(run.max_speed_mps() < kAtRest_mps);
  run.cut("coordinator", agent_process(1), false);
  run.system.run_for(seconds(5));
  run.require_held(0);
}

// The agent that remembers the hold hears coordinator 1, but for a while coordinator 1 does not hear that
// agent.
TEST_CASE(
    "a hold that only one agent remembers stays in force although the new coordinator does not hear that "
    "agent") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  Fleet run(3, 2, seed);
  run.isolate("coordinator 1");
  run.cut("coordinator", agent_process(2));
  run.system.run_for(milliseconds(100));
  run.hold(0);
  run.system.kill("coordinator");
  run.system.kill(agent_process(0));
  run.isolate("coordinator 1", false);
  run.cut_one_way(agent_process(1), "coordinator 1");
  run.system.restart(agent_process(0));
  run.send(msg::OrderKind::ORDER_GO, 0, kOtherClient, {{{2, 1}}});
  CHECK_FALSE(run.moves(seconds(3)));
  run.cut_one_way(agent_process(1), "coordinator 1", false);
  run.system.run_for(seconds(5));
  run.require_held(0);
}

// Coordinator 0 hears every process, but only the client hears coordinator 0.
TEST_CASE("a coordinator does not confirm a hold while no agent hears the coordinator") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  Fleet run(3, 2, seed);
  for (const std::string& other : system_process_names(run.scenario))
    if (other != "coordinator") run.cut_one_way("coordinator", other);
  const auto hold = run.send(msg::OrderKind::ORDER_HOLD, 0, kClient);
  run.system.run_for(milliseconds(100));
  CHECK_FALSE(run.answers.contains(hold));
  // Coordinator 1 takes over, and confirms the hold once it remembers the hold.
  CHECK(run.run_until(seconds(5), [&] {
    Order again{msg::OrderKind::ORDER_HOLD, 0, kClient, hold};
    run.system.send(again);
    run.system.run_for(milliseconds(200));
    return run.answers.contains(hold);
  }));
  run.require_held(0);
}

TEST_CASE("an order and a zone survive the death of their coordinator, even if the standby was partitioned") {
  Fleet run(3, 2, 1);
  run.isolate("coordinator 1");
  run.system.run_for(milliseconds(500));
  run.hold(kAllRobots);
  run.draw(7, {{{0, 0}}, 0.5});
  const auto go = run.send(msg::OrderKind::ORDER_GO, 1, kClient, {{{1, 1}}});
  run.system.run_for(seconds(1));
  run.system.kill("coordinator");
  run.system.kill(agent_process(1));
  run.isolate("coordinator 1", false);
  run.system.restart(agent_process(1));
  CHECK_FALSE(run.moves(seconds(5)));
  run.send(msg::OrderKind::ORDER_RESUME, kAllRobots, kClient);
  CHECK(run.run_until(seconds(10), [&] { return run.arrived.contains(go); }));
  run.require_safe();
}

TEST_CASE("robots are held after coordinators and agents have all restarted, even if no robot has moved") {
  const int coordinators = GENERATE(1, 2);
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(coordinators, seed);
  OrderedSystem run(waiting_robots(3, coordinators), seed);
  run.system.run_for(seconds(2));
  const bool is_held = GENERATE(true, false);  // after the restart no process knows whether a robot was held
  if (is_held) {
    const auto hold = run.send(msg::OrderKind::ORDER_HOLD, 0, kOperator);
    REQUIRE(run.run_until(seconds(3), [&] { return run.answers.contains(hold); }));
  }
  run.restart_everything();
  run.system.run_for(seconds(5));
  const auto go = run.send(msg::OrderKind::ORDER_GO, 0, kClient, {{{2, 1}}});
  CHECK_FALSE(run.run_until(seconds(5), [&] { return run.max_speed_mps() > kAtRest_mps; }));
  run.send(msg::OrderKind::ORDER_RESUME, kAllRobots, kOperator);
  CHECK(run.run_until(seconds(10), [&] { return run.arrived.contains(go); }));
  run.require_safe();
}

TEST_CASE(
    "robots with goals keep resting after a confirmed hold even if coordinators and agents all restart") {
  for (const int started_ms : {100, 300, 1000, 1300, 1700}) {
    const int coordinators = GENERATE(1, 2);
    CAPTURE(started_ms, coordinators);
    Scenario scenario = waiting_robots(3, coordinators);
    for (RobotSpec& robot : scenario.robots) robot.goals = {{-robot.start_m}};
    OrderedSystem run(scenario, 1);
    run.system.run_for(milliseconds(started_ms));
    const auto hold = run.send(msg::OrderKind::ORDER_HOLD, 0, kClient);
    run.system.run_for(milliseconds(200));
    const bool is_confirmed = run.answers.contains(hold);
    run.restart_everything();
    run.system.run_for(seconds(8));
    if (is_confirmed) CHECK(run.max_speed_mps() < kAtRest_mps);
    run.require_safe();
  }
}

TEST_CASE("a fleet is not held if single coordinators or agents restart while the fleet starts") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    INFO("seed " << seed);
    Rng rng(seed);
    const int coordinators = 1 + static_cast<int>(seed % 2);
    Scenario scenario = waiting_robots(4, coordinators);
    for (RobotSpec& robot : scenario.robots) robot.goals = {{robot.start_m + Vec2(0, 1)}};
    OrderedSystem run(scenario, seed);
    run.system.run_for(milliseconds(rng.below(1500)));
    // Restarts only one process: if a coordinator and an agent die together, an order might be forgotten.
    const std::string victim = rng.below(2)
                                   ? agent_process(rng.below(4))
                                   : coordinator_process(rng.below(static_cast<std::uint32_t>(coordinators)));
    run.system.kill(victim);
    run.system.run_for(milliseconds(rng.below(300)));
    run.system.restart(victim);
    CHECK(run.system.run_until_arrived(run.system.now() + seconds(20)));
    run.require_safe();
  }
}

// Each trial holds a robot with the client library, causes partitions and crashes, and then orders the robot
// away. It never kills the last process that remembers the hold.
TEST_CASE("no confirmed hold is lost in random partitions and crashes") {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    INFO("seed " << seed);
    Rng rng(seed);
    const int coordinators = 1 + static_cast<int>(seed % 2);
    Fleet run(4, coordinators, seed);
    std::vector<std::string> victims = system_process_names(run.scenario);
    std::erase_if(victims, [](const std::string& name) { return name == "simulator" || name == "vision"; });
    const auto any = [&] { return victims[rng.below(static_cast<std::uint32_t>(victims.size()))]; };
    std::set<std::pair<std::string, std::string>> links;
    const auto cut_some = [&] {
      for (std::uint32_t i = rng.below(4); i > 0; --i) {
        const std::string a = any(), b = any();
        if (a == b) continue;
        run.cut_one_way(a, b);
        links.insert({a, b});
      }
    };
    cut_some();
    const auto robot = static_cast<RobotId>(rng.below(4));
    const auto hold = run.send(msg::OrderKind::ORDER_HOLD, robot, kClient);
    run.run_until(seconds(4), [&] {
      Order again{msg::OrderKind::ORDER_HOLD, robot, kClient, hold};
      run.system.send(again);
      run.system.run_for(milliseconds(200));
      return run.answers.contains(hold);
    });
    if (!run.answers.contains(hold)) continue;
    run.system.run_for(milliseconds(rng.below(3000)));
    // An agent that has heard the hold stays alive.
    const std::string survivor = agent_process(robot);
    for (int i = 0; i < 6; ++i) {
      cut_some();
      const std::string victim = any();
      if (victim != survivor) {
        run.system.kill(victim);
        run.system.run_for(milliseconds(rng.below(600)));
        run.system.restart(victim);
      }
      run.system.run_for(milliseconds(rng.below(1000)));
      if (rng.below(2)) {
        for (const auto& [a, b] : links) run.cut_one_way(a, b, false);
        links.clear();
      }
    }
    for (const auto& [a, b] : links) run.cut_one_way(a, b, false);
    run.send(msg::OrderKind::ORDER_GO, robot, kOtherClient, {{{2, 1}}});
    CHECK_FALSE(run.moves(seconds(6)));
    CHECK(run.statuses[robot].is_held());
    run.require_safe();
  }
}

}  // namespace sidestep::remembered_orders_test
