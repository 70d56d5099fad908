// SPDX-License-Identifier: Apache-2.0
// Orders at run time, in whole systems.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "common/client/order_client.hpp"
#include "common/config/scenario_loader.hpp"
#include "common/protocol/process_names.hpp"
#include "common/random/rng.hpp"
#include "tests/catch.hpp"
#include "tests/sim/disturbance.hpp"
#include "tests/sim/ordered_system.hpp"

namespace sidestep::orders_test {

using std::chrono::milliseconds;
using std::chrono::seconds;

Scenario shipped(const std::string& name) {
  return load_scenario(std::string(SIDESTEP_SOURCE_DIR) + "/deploy/scenarios/" + name + ".yaml");
}

TEST_CASE("robots without goals wait for orders, and drive through the ordered poses one after another") {
  OrderedSystem run(waiting_robots(4), 1);
  run.system.run_for(seconds(2));
  CHECK(run.max_speed_mps() < kAtRest_mps);
  CHECK(run.statuses[0].order_number() == 0);
  const auto order = run.send(msg::OrderKind::ORDER_GO, 0, kClient, {{{0, 0}}, {{1, 2}, 1.0, 0.5}});
  double fastest_mps = 0;
  CHECK(run.run_until(seconds(20), [&] {
    if (run.statuses[0].pose_index() == 1) fastest_mps = std::max(fastest_mps, run.max_speed_mps());
    return run.arrived.contains(order);
  }));
  CHECK(run.answers[order] == msg::OrderResult::RESULT_REMEMBERED);
  CHECK(fastest_mps > 0.4);
  CHECK(fastest_mps < 0.55);
  CHECK(run.send(msg::OrderKind::ORDER_GO, 9, kClient, {{{0, 0}}}) > 0);
  CHECK(run.run_until(seconds(1), [&] { return run.answers.contains(run.number); }));
  CHECK(run.answers[run.number] == msg::OrderResult::RESULT_UNKNOWN_ROBOT);
  run.require_safe();
}

TEST_CASE("an agent reports the name of the client whose order its robot carries out") {
  OrderedSystem run(waiting_robots(2), 1);
  SimBus bus(run.system.network());
  OrderClient client(bus, client_id("kitchen"), "kitchen");
  run.system.run_for(seconds(2));
  client.go(0, {{{0, 0}}});
  const auto name = [&] {
    const auto report = client.reports().find(0);
    return report == client.reports().end() ? std::string() : to_text(report->second.client_name);
  };
  CHECK(run.run_until(seconds(5), [&] { return name() == "kitchen"; }));
  run.require_safe();
}

TEST_CASE(
    "twenty-two robots that are held at full speed come to rest within the braking time and three cycles") {
  const double loss = GENERATE(0.0, 0.05);
  CAPTURE(loss);
  std::vector<double> delays_s;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Scenario scenario = shipped("two-teams-22");
    scenario.network.loss = loss;
    OrderedSystem run(scenario, seed);
    const double full_mps = scenario.limits.speed_mps;
    REQUIRE(run.run_until(seconds(10), [&] { return run.max_speed_mps() > 0.98 * full_mps; }));
    const Time ordered_at = run.system.now();
    run.send(msg::OrderKind::ORDER_HOLD, kAllRobots, kOperator);
    REQUIRE(run.run_until(seconds(5), [&] { return run.max_speed_mps() < kAtRest_mps; }));
    run.system.run_for(seconds(1));
    delays_s.push_back(to_seconds(run.moved_at - ordered_at));
    CHECK(run.max_speed_mps() < kAtRest_mps);
    run.send(msg::OrderKind::ORDER_RESUME, kAllRobots, kOperator);
    CHECK(run.system.run_until_arrived(run.system.begin() + from_seconds(scenario.time_limit_s)));
    run.require_safe();
  }
  std::ranges::sort(delays_s);
  const Scenario scenario = shipped("two-teams-22");
  const double budget_s = scenario.limits.speed_mps / scenario.limits.deceleration_mps2 +
                          3 * to_seconds(scenario.cycle) + (loss > 0 ? 0.2 : 0);
  WARN("loss " << loss << ": median " << delays_s[10] << " s, longest " << delays_s.back() << " s, budget "
               << budget_s << " s");
  CHECK(delays_s.back() <= budget_s);
}

TEST_CASE(
    "a hold survives the restart of the coordinator or agents or both, until its owner or an operator "
    "resumes") {
  const int coordinators = GENERATE(1, 2);
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(coordinators, seed);
  Scenario scenario = shipped("crossing");
  scenario.coordinators = coordinators;
  OrderedSystem run(scenario, seed);
  REQUIRE(run.run_until(seconds(5), [&] { return run.max_speed_mps() > 1; }));
  run.send(msg::OrderKind::ORDER_HOLD, kAllRobots, kClient);
  REQUIRE(run.run_until(seconds(3), [&] { return run.max_speed_mps() < kAtRest_mps; }));
  const auto stays = [&](Duration duration) {
    return !run.run_until(duration, [&] { return run.max_speed_mps() > kAtRest_mps; });
  };
  const auto restart = [&](const std::string& process) {
    run.system.kill(process);
    run.system.run_for(milliseconds(50));
    run.system.restart(process);
  };
  restart("coordinator");
  CHECK(stays(seconds(4)));
  for (const RobotSpec& robot : scenario.robots) restart(agent_process(robot.id));
  CHECK(stays(seconds(4)));
  // Kills all coordinators and agents simultaneously.
  for (const std::string& process : system_process_names(scenario)) {
    if (process != "simulator" && process != "vision") run.system.kill(process);
  }
  for (const std::string& process : system_process_names(scenario)) run.system.restart(process);
  CHECK(stays(seconds(5)));
  // Another client cannot lift the hold. After a restart of all coordinators and agents, its owner cannot
  // lift it either.
  run.send(msg::OrderKind::ORDER_RESUME, kAllRobots, kOtherClient);
  run.send(msg::OrderKind::ORDER_RESUME, kAllRobots, kClient);
  CHECK(stays(seconds(2)));
  run.send(msg::OrderKind::ORDER_RESUME, kAllRobots, kOperator);
  std::vector<OrderNumber> orders;
  for (const RobotSpec& robot : scenario.robots)
    orders.push_back(run.send(msg::OrderKind::ORDER_GO, robot.id, kClient, robot.goals));
  CHECK(run.run_until(seconds(30), [&] {
    return std::ranges::all_of(orders, [&](OrderNumber order) { return run.arrived.contains(order); });
  }));
  run.require_safe();
}

TEST_CASE("no order is lost while agents and coordinators are killed") {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    INFO("seed " << seed);
    Rng rng(seed);
    Scenario scenario = waiting_robots(8, 2);
    scenario.network.loss = 0.05;
    OrderedSystem run(scenario, seed);
    run.system.run_for(seconds(1));
    std::map<RobotId, OrderNumber> latest;
    for (int i = 0; i < 60; ++i) {
      const RobotId robot = rng.below(8);
      const Goal goal{{rng.uniform(-2.8, 2.8), rng.uniform(-2.3, 2.3)}};
      latest[robot] =
          run.send(msg::OrderKind::ORDER_GO, robot, rng.below(2) ? kClient : kOtherClient, {goal});
      const std::string victim =
          rng.below(3) ? agent_process(rng.below(8)) : coordinator_process(rng.below(2));
      if (rng.below(3) == 0) {
        run.system.kill(victim);
        run.system.run_for(milliseconds(rng.below(400)));
        run.system.restart(victim);
      }
      run.system.run_for(milliseconds(rng.below(500)));
    }
    // Each robot carries out its last order, or rests as near to the goal as other robots permit.
    run.run_until(seconds(40), [&] {
      return std::ranges::all_of(latest, [&](const auto& l) { return run.arrived.contains(l.second); });
    });
    for (const auto& [robot, order] : latest) {
      INFO("robot " << robot);
      CHECK(run.statuses[robot].order_number() == order);
    }
    run.require_safe();
  }
}

/// A client with its own link, which sends robots to random goals that do not overlap.
struct RandomClient {
  static constexpr int kColumns = 6, kRows = 5;
  SimBus bus;
  OrderClient client;
  Rng rng;
  std::map<RobotId, int> places;
  std::vector<OrderHandle> sent;

  RandomClient(SimNetwork& network, std::uint64_t seed) : bus(network), client(bus, kClient), rng(seed) {}
  void send_one(RobotId robot) {
    int place = 0;
    do {
      place = static_cast<int>(rng.below(kColumns * kRows));
    } while (std::ranges::any_of(places, [&](const auto& taken) { return taken.second == place; }));
    places[robot] = place;
    sent.push_back(client.go(robot, {{{-2 + 0.8 * (place % kColumns), -1.6 + 0.8 * (place / kColumns)}}}));
  }
  std::size_t count(OrderPhase phase) const {
    return static_cast<std::size_t>(
        std::ranges::count_if(sent, [&](OrderHandle handle) { return client.find(handle)->phase == phase; }));
  }
};

TEST_CASE("a client learns the outcome of every order even if random agents and coordinators are killed") {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    INFO("seed " << seed);
    Rng rng(seed);
    Scenario scenario = waiting_robots(8, 1 + static_cast<int>(seed % 2));
    scenario.network.loss = 0.05;
    OrderedSystem run(scenario, seed);
    RandomClient random(run.system.network(), seed);
    std::map<std::string, Time> dead_until;
    for (int i = 0; i < 400; ++i) {
      run.system.run_for(milliseconds(100));
      if (rng.below(3) == 0) random.send_one(static_cast<RobotId>(rng.below(8)));
      // If all processes that remember that there was no earlier order are killed, robots are held until an
      // operator resumes them.
      if (run.system.now() < run.system.begin() + seconds(3)) continue;
      for (const std::string& process : system_process_names(scenario)) {
        if (process == "simulator" || process == "vision") continue;
        if (run.system.is_alive(process) && rng.below(100) == 0) {
          run.system.kill(process);
          dead_until[process] = run.system.now() + milliseconds(rng.below(1500));
        } else if (!run.system.is_alive(process) && run.system.now() >= dead_until[process]) {
          run.system.restart(process);
        }
      }
    }
    for (const std::string& process : system_process_names(scenario)) run.system.restart(process);
    const auto is_over = [&] {
      return random.count(OrderPhase::kArrived) + random.count(OrderPhase::kReplaced) == random.sent.size();
    };
    CHECK(run.run_until(seconds(40), is_over));
    CAPTURE(random.sent.size(), random.count(OrderPhase::kSent), random.count(OrderPhase::kAccepted),
            random.count(OrderPhase::kDriving), random.count(OrderPhase::kRefused));
    CHECK(is_over());
    CHECK(random.count(OrderPhase::kArrived) > 20);
    run.require_safe();
  }
}

TEST_CASE(
    "orders take effect in the sequence in which clients give them, although the clients' clocks differ") {
  OrderedSystem run(shipped("crossing"), 1);
  SimNetwork& network = run.system.network();
  SimBus early_bus(network, {network.new_process(), {seconds(-20), 0, run.system.begin()}});
  SimBus late_bus(network, {network.new_process(), {seconds(20), 0, run.system.begin()}});
  OrderClient early(early_bus, kClient), late(late_bus, kOperator);
  REQUIRE(run.run_until(seconds(5), [&] { return run.max_speed_mps() > 1; }));
  const auto rests = [&] { return run.max_speed_mps() < kAtRest_mps; };
  const auto drives = [&] { return run.max_speed_mps() > 0.5; };
  for (int i = 0; i < 2; ++i) {
    late.hold(kAllRobots);
    CHECK(run.run_until(seconds(2), rests));
    late.resume(kAllRobots);
    CHECK(run.run_until(seconds(2), drives));
    early.hold(kAllRobots);
    CHECK(run.run_until(seconds(2), rests));
    early.resume(kAllRobots);
    CHECK(run.run_until(seconds(2), drives));
  }
  OrderClient stranger(late_bus, kOtherClient);
  const Vec2 position = shipped("crossing").robots[0].start_m;
  stranger.go(0, {{position}});
  run.system.run_for(milliseconds(100));
  const OrderHandle last = early.go(0, {{position}});
  run.system.run_for(milliseconds(300));
  CHECK(early.find(last)->phase == OrderPhase::kDriving);
}

TEST_CASE("robots that have made own stops before the first grant are not held") {
  OrderedSystem run(shipped("crossing"), 1);
  run.system.kill("coordinator");
  run.system.run_for(milliseconds(100));
  auto reboot = disturbance(3, msg::DisturbanceKind::DISTURBANCE_REBOOT);
  run.system.disturb(reboot);
  run.system.run_for(milliseconds(200));
  run.system.restart("coordinator");
  CHECK(run.system.run_until_arrived(run.system.now() + seconds(20)));
  run.require_safe();
}

TEST_CASE(
    "another robot's agent restores an order after the coordinator and the robot's own agent have "
    "restarted") {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    INFO("seed " << seed);
    OrderedSystem run(waiting_robots(3), seed);
    run.system.run_for(seconds(1));
    const auto order = run.send(msg::OrderKind::ORDER_GO, 0, kClient, {{{2, 2}}});
    run.system.run_for(milliseconds(300));
    run.system.kill("coordinator");
    run.system.kill(agent_process(0));
    run.system.run_for(milliseconds(100));
    run.system.restart("coordinator");
    run.system.restart(agent_process(0));
    CHECK(run.run_until(seconds(20), [&] { return run.arrived.contains(order); }));
    run.require_safe();
  }
}

TEST_CASE(
    "a client that sends each order only once gets answers only for orders that survive the coordinator") {
  int answered = 0, lost = 0, unanswered = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const int coordinators = 1 + static_cast<int>(rng.below(2));
    OrderedSystem run(waiting_robots(3, coordinators), seed);
    run.system.run_for(seconds(2));
    // The active coordinator is cut off, so that no other process hears it, and dies later.
    const std::string victim = "coordinator";
    const Duration until_cut = milliseconds(rng.below(40)), until_death = milliseconds(rng.below(300));
    const OrderNumber zone = run.draw(7, {{{2.5, 2}}, 0.1});
    const OrderNumber go = run.send(msg::OrderKind::ORDER_GO, 0, kClient, {{{1, 1.5}}});
    run.system.run_for(until_cut);
    for (const std::string& other : system_process_names(run.scenario))
      if (other != victim) run.cut_one_way(victim, other);
    const OrderNumber cancel = run.send(msg::OrderKind::ORDER_CANCEL, 0, kClient);
    run.system.run_for(until_death);
    const auto is_accepted = [&](OrderNumber order) {
      const auto found = run.answers.find(order);
      return found != run.answers.end() && found->second == msg::OrderResult::RESULT_REMEMBERED;
    };
    const bool has_zone = is_accepted(zone), has_go = is_accepted(go), has_cancel = is_accepted(cancel);
    run.system.kill(victim);
    for (const std::string& other : system_process_names(run.scenario))
      if (other != victim) run.cut_one_way(victim, other, false);
    run.system.restart(victim);
    std::set<OrderNumber> remembered;
    SimBus listener(run.system.network());
    listener.become_observer();
    run.system.run_for(seconds(3));
    listener.subscribe(topics::kOrderMemory, [&](const msg::OrderMemory& message) {
      const auto page = decode(message, listener.now());
      REQUIRE(page);
      for (const RememberedOrder& order : page->orders) remembered.insert(order.order.number);
    });
    run.system.run_for(seconds(2));
    answered += has_zone + has_go + has_cancel;
    unanswered += 3 - has_zone - has_go - has_cancel;
    lost += has_zone && !remembered.contains(zone);
    lost += has_go && !remembered.contains(go) && !remembered.contains(cancel);
    lost += has_cancel && !remembered.contains(cancel);
    run.require_safe();
  }
  CHECK(lost == 0);
  CHECK(answered > 100);
  CHECK(unanswered > 100);
}

TEST_CASE("ten thousand orders a second neither stop a run nor fill memory") {
  OrderedSystem run(waiting_robots(4), 1);
  run.system.run_for(seconds(1));
  const auto order = run.send(msg::OrderKind::ORDER_GO, 0, kOperator, {{{1, 0}}});
  Rng rng(1);
  for (int i = 0; i < 20000; ++i) {
    run.number = static_cast<OrderNumber>(to_ns(run.system.now())) + rng.below(1000);
    const auto kind = static_cast<msg::OrderKind>(rng.below(6));
    const auto robot = static_cast<RobotId>(rng.below(5));
    Order flood{kind, robot, kClient + static_cast<ClientId>(rng.below(100'000)), run.number};
    // A hold of robot 0 would correctly stop it, so the flood holds only other robots.
    if (flood.kind == msg::OrderKind::ORDER_HOLD || flood.kind == msg::OrderKind::ORDER_RESUME)
      flood.robot = 1 + robot % 4;
    if (flood.kind == msg::OrderKind::ORDER_GO) flood.goals = {{{rng.uniform(-5, 5), 0}}};
    if (flood.kind == msg::OrderKind::ORDER_ZONE) flood.zone.corners_m = {{2.5, 2}};
    if (flood.kind >= msg::OrderKind::ORDER_ZONE) flood.robot = kAllRobots;
    flood.zone_number = static_cast<std::uint32_t>(rng.below(1'000'000));
    run.system.send(flood);
    run.system.run_for(std::chrono::microseconds(100));
  }
  CHECK(run.run_until(seconds(10), [&] { return run.arrived.contains(order); }));
  run.require_safe();
}

}  // namespace sidestep::orders_test
