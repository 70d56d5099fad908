// SPDX-License-Identifier: Apache-2.0
// Goals that cannot be reached, and zones, in whole systems.
#include "agents/navigation/zone_map.hpp"
#include "common/collision/shapes.hpp"
#include "common/config/scenario_loader.hpp"
#include "common/random/rng.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "tests/sim/disturbance.hpp"
#include "tests/sim/ordered_system.hpp"

namespace sidestep::blocked_test {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr double kRadius_m = 0.09,
                 kMaxWaitingGap_m = 0.08;  // kMaxWaitingGap_m covers margin, extra clearance and noise

/// Runs until the robot rests and reports that it is blocked for this reason; false after 15 s.
bool comes_to_rest_blocked(OrderedSystem& run, RobotId robot, msg::BlockReason reason) {
  return run.run_until(seconds(15), [&] {
    const msg::OrderStatus& status = run.statuses[robot];
    return status.order_state() == msg::OrderState::ORDER_BLOCKED && status.block_reason() == reason &&
           run.bodies[robot].velocity_mps.norm() < kAtRest_mps &&
           (run.bodies[robot].position_m - Vec2(status.nearest_x_m(), status.nearest_y_m())).norm() < 0.01;
  });
}
double distance(OrderedSystem& run, RobotId robot, const Vec2& place) {
  return (run.bodies[robot].position_m - place).norm();
}

TEST_CASE(
    "a robot without an order leaves a place to which others are sent, and so does one that has arrived") {
  OrderedSystem run(waiting_robots(4), 1);
  const Vec2 place(2, -1.5);  // position of robot 1
  run.system.run_for(seconds(1));
  for (const RobotId robot : {0, 2}) {
    CAPTURE(robot);
    const auto order = run.send(msg::OrderKind::ORDER_GO, robot, kClient, {{place}});
    CHECK(run.run_until(seconds(15), [&] { return run.arrived.contains(order); }));
    // Those that would come back to this place let the robot stay.
    run.system.run_for(seconds(10));
    CHECK(distance(run, robot, place) < kRadius_m / 2);
  }
  // The others wait nearby.
  for (const RobotId robot : {0, 1}) CHECK(distance(run, robot, place) < 1);
  run.require_safe();
}

TEST_CASE("robots wait beside a held robot that rests on their goal, and continue when the goal is free") {
  OrderedSystem run(waiting_robots(4), 1);
  const Vec2 place(2, -1.5);  // position of robot 1
  run.system.run_for(seconds(1));
  run.send(msg::OrderKind::ORDER_HOLD, 1, kClient);
  const auto order = run.send(msg::OrderKind::ORDER_GO, 0, kClient, {{place}});
  REQUIRE(comes_to_rest_blocked(run, 0, msg::BlockReason::BLOCK_ROBOT));
  CHECK(run.statuses[0].blocker() == 1);
  CHECK(distance(run, 0, place) < 2 * kRadius_m + kMaxWaitingGap_m);
  run.system.run_for(seconds(3));
  CHECK(comes_to_rest_blocked(run, 0, msg::BlockReason::BLOCK_ROBOT));
  // Robot 2 waits next to robots 0 and 1.
  const auto third = run.send(msg::OrderKind::ORDER_GO, 2, kClient, {{place}});
  REQUIRE(comes_to_rest_blocked(run, 2, msg::BlockReason::BLOCK_ROBOT));
  run.send(msg::OrderKind::ORDER_RESUME, 1, kClient);
  run.send(msg::OrderKind::ORDER_GO, 1, kClient, {{{0, 0}}});
  CHECK(
      run.run_until(seconds(10), [&] { return run.arrived.contains(order) || run.arrived.contains(third); }));
  run.require_safe();
}

TEST_CASE(
    "a robot waits beside another robot that is held on its goal, and both arrive after the hold is lifted") {
  OrderedSystem run(waiting_robots(2), 1);
  run.system.run_for(seconds(1));
  const auto first = run.send(msg::OrderKind::ORDER_GO, 1, kClient, {{{-2, 2}}});
  REQUIRE(run.run_until(seconds(5), [&] { return run.bodies[1].position_m.x() < 0.5; }));
  run.send(msg::OrderKind::ORDER_HOLD, 1, kClient);
  REQUIRE(run.run_until(seconds(5), [&] { return run.bodies[1].velocity_mps.norm() < kAtRest_mps; }));
  const Vec2 place = run.bodies[1].position_m;
  const auto second = run.send(msg::OrderKind::ORDER_GO, 0, kClient, {{place}});
  REQUIRE(comes_to_rest_blocked(run, 0, msg::BlockReason::BLOCK_ROBOT));
  CHECK(distance(run, 0, place) < 2 * kRadius_m + kMaxWaitingGap_m);
  run.send(msg::OrderKind::ORDER_RESUME, 1, kClient);
  CHECK(run.run_until(seconds(10),
                      [&] { return run.arrived.contains(first) && run.arrived.contains(second); }));
  run.require_safe();
}

TEST_CASE("robots that rest on each other's goals exchange places") {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    INFO("seed " << seed);
    OrderedSystem run(waiting_robots(6), seed);
    Rng rng(seed);
    run.system.run_for(seconds(1));
    // Robots 0, 2 and 4 start in a row. All three rotate their positions, or two of them swap.
    std::vector<OrderNumber> orders;
    const std::size_t count = 2 + rng.below(2);
    for (std::size_t i = 0; i < count; ++i) {
      const auto robot = static_cast<RobotId>(2 * i), next = static_cast<RobotId>(2 * ((i + 1) % count));
      orders.push_back(run.send(msg::OrderKind::ORDER_GO, robot, kClient, {{run.bodies[next].position_m}}));
    }
    CHECK(run.run_until(seconds(20), [&] {
      return std::ranges::all_of(orders, [&](OrderNumber order) { return run.arrived.contains(order); });
    }));
    run.require_safe();
  }
}

TEST_CASE(
    "a robot leaves a zone drawn over it or its goal, and returns to its goal when the zone is removed") {
  OrderedSystem run(waiting_robots(4), 1);
  run.system.run_for(seconds(1));
  const Vec2 place(0, 0), home(2, -0.5);  // positions of robot 3, which has no order
  const auto order = run.send(msg::OrderKind::ORDER_GO, 0, kClient, {{place}});
  REQUIRE(run.run_until(seconds(5), [&] { return run.bodies[0].position_m.x() > -1.5; }));
  run.draw(4, {{{-0.2, -0.4}, {0.2, -0.4}, {0.2, 0.4}, {-0.2, 0.4}}, 0});
  REQUIRE(comes_to_rest_blocked(run, 0, msg::BlockReason::BLOCK_ZONE));
  CHECK(run.statuses[0].blocker() == 4);
  CHECK(distance(run, 0, place) < 0.2 + kRadius_m + kMaxWaitingGap_m);
  CHECK(std::abs(run.bodies[0].position_m.x()) > 0.2 + kRadius_m);
  run.erase(4);
  CHECK(run.run_until(seconds(5), [&] { return run.arrived.contains(order); }));
  CHECK(run.run_until(seconds(1), [&] { return distance(run, 0, place) < 0.01; }));
  // Robots without an order, and robots that have already arrived, also leave the zone.
  run.draw(5, {{place}, 0.3});
  run.draw(6, {{home, home + Vec2(0, 1)}, 0.2});
  const auto are_out = [&] {
    return distance(run, 0, place) > 0.3 + kRadius_m && distance(run, 3, home) > 0.2 + kRadius_m;
  };
  CHECK(run.run_until(seconds(3), are_out));
  CHECK(run.run_until(seconds(1), [&] { return run.max_speed_mps() < kAtRest_mps; }));
  CHECK(are_out());
  CHECK(run.statuses[0].block_reason() == msg::BlockReason::BLOCK_ZONE);
  run.erase(5);
  run.erase(6);
  CHECK(run.run_until(seconds(5), [&] { return distance(run, 0, place) < 0.01; }));
  CHECK(distance(run, 3, home) > 0.2 + kRadius_m);
  run.require_safe();
}

TEST_CASE("robots inside several overlapping zones leave all of them") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    INFO("seed " << seed);
    OrderedSystem run(waiting_robots(4), seed);
    Rng rng(seed);
    run.system.run_for(seconds(1));
    const Vec2 home(-2, -1.5);  // position of robot 0
    std::vector<Order> zones(3);
    for (std::uint32_t i = 0; i < 3; ++i) {
      Zone& zone = zones[i].zone;
      const auto corner = [&] {
        return Vec2(home + rotated({rng.uniform(0, 0.3), 0}, rng.uniform(0, 6.28)));
      };
      zone = {{corner(), corner()}, rng.uniform(0.1, 0.4)};
      run.draw(i, zone);
    }
    const ZoneMap map(zones);
    CHECK(run.run_until(seconds(5), [&] { return !map.is_kept_out(run.bodies[0].position_m, kRadius_m); }));
    CHECK(run.run_until(seconds(1), [&] { return run.max_speed_mps() < kAtRest_mps; }));
    CHECK_FALSE(map.is_kept_out(run.bodies[0].position_m, kRadius_m));
    run.require_safe();
  }
}

TEST_CASE(
    "a robot drives as near as possible to a goal in an obstacle or behind a closed ring of obstacles") {
  std::string obstacles = "obstacles:\n  - {centre_m: [0, -1], radius_m: 0.3}\n";
  for (int i = 0; i < 12; ++i) {
    const Vec2 centre = Vec2(0, 1) + rotated({0.6, 0}, i * 0.5236);
    obstacles += "  - {centre_m: [" + std::to_string(centre.x()) + ", " + std::to_string(centre.y()) +
                 "], radius_m: 0.15}\n";
  }
  OrderedSystem run(waiting_robots(2, 1, obstacles), 1);
  run.system.run_for(seconds(1));
  run.send(msg::OrderKind::ORDER_GO, 0, kClient, {{{-0.1, -1}}});
  REQUIRE(comes_to_rest_blocked(run, 0, msg::BlockReason::BLOCK_OBSTACLE));
  CHECK(run.statuses[0].blocker_y_m() == -1);
  CHECK(distance(run, 0, {-0.1, -1}) < 0.2 + kRadius_m + kMaxWaitingGap_m);
  run.send(msg::OrderKind::ORDER_GO, 1, kClient, {{{0, 1}}});
  REQUIRE(comes_to_rest_blocked(run, 1, msg::BlockReason::BLOCK_NO_PATH));
  CHECK(distance(run, 1, {0, 1}) < 0.75 + kRadius_m + kMaxWaitingGap_m);
  run.send(msg::OrderKind::ORDER_CANCEL, 1, kClient);
  CHECK(run.run_until(seconds(2), [&] { return run.statuses[1].order_number() == 0; }));
  run.require_safe();
}

TEST_CASE("no robot enters a keep-out zone or exceeds a zone's speed limit") {
  int arrived = 0, blocked = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    INFO("seed " << seed);
    Rng rng(seed);
    OrderedSystem run(waiting_robots(8), seed);
    const double speed_limit_mps = rng.uniform(0.3, 1);
    std::vector<Zone> zones;
    for (int i = 0; i < 4; ++i) {
      Zone zone;
      const double y = rng.uniform(-1.8, 1.8), x = rng.uniform(-1.1, 1.1);
      for (std::uint64_t k = 1 + rng.below(4); k > 0; --k)
        zone.corners_m.emplace_back(x + rng.uniform(-0.4, 0.4), y + rng.uniform(-0.4, 0.4));
      zone.radius_m = rng.uniform(0.05, 0.3);
      if (i == 3) zone.speed_limit_mps = speed_limit_mps;
      zones.push_back(zone);
      run.draw(static_cast<std::uint32_t>(i), zone);
    }
    const ZoneMap map([&] {
      std::vector<Order> orders;
      for (const Zone& zone : zones) {
        Order& order = orders.emplace_back();
        order.zone = zone;
      }
      return orders;
    }());
    const Shape slow = outline_of(zones[3]);
    run.system.run_for(seconds(1));
    std::vector<OrderNumber> orders;
    for (RobotId robot = 0; robot < 8; ++robot) {
      const double side = robot % 2 ? -1 : 1;
      orders.push_back(run.send(msg::OrderKind::ORDER_GO, robot, kClient,
                                {{{side * rng.uniform(0, 2.5), rng.uniform(-2, 2)}}}));
    }
    int entered = 0, too_fast = 0;
    const auto is_over = [&] {
      for (const auto& [robot, body] : run.bodies) {
        // A body is up to 5 mm from its reference.
        entered += map.is_kept_out(body.position_m, kRadius_m - 0.005);
        too_fast += signed_distance(body.position_m, slow) < kRadius_m - 0.005 &&
                    body.velocity_mps.norm() > speed_limit_mps + 0.05;
      }
      return std::ranges::all_of(run.statuses, [&](const auto& entry) {
        return run.arrived.contains(entry.second.order_number()) ||
               (entry.second.order_state() == msg::OrderState::ORDER_BLOCKED &&
                run.bodies[entry.first].velocity_mps.norm() < kAtRest_mps);
      });
    };
    CHECK(run.run_until(seconds(60), is_over));
    CHECK(entered == 0);
    CHECK(too_fast == 0);
    for (const auto& [robot, status] : run.statuses)
      ++(run.arrived.contains(status.order_number()) ? arrived : blocked);
    run.require_safe();
  }
  WARN(arrived << " arrived, " << blocked << " blocked");
  CHECK(arrived > 80);
  CHECK(blocked > 5);
}

TEST_CASE("the report says why each robot has not arrived") {
  const Scenario scenario = parse_scenario(
      "field: {length_m: 8, width_m: 5}\nobstacles:\n"
      "  - wall: {points_m: [[1, -1], [3, -1], [3, 1], [1, 1], [1, -1]], thickness_m: 0.1}\n"
      "robots:\n  - {id: 0, start_m: [-3, 0], goals_m: [[2, 0]]}\n"
      "  - {id: 1, start_m: [-3, 1], goals_m: [[3.5, 1.5]]}\n"
      "  - {id: 2, start_m: [-3, 2], goals_m: [[3, 2]]}\n  - {id: 3, start_m: [-3, -2], goals_m: [[3, -2]]}\n"
      "  - {id: 4, start_m: [-3.5, -1], goals_m: [[-2, -1]]}\n",
      "closed.yaml");
  SimSystem system(scenario, 1);
  system.run_for(std::chrono::milliseconds(1500));
  system.send({msg::OrderKind::ORDER_HOLD, 2, static_cast<ClientId>(Sender::kOperator),
               static_cast<OrderNumber>(to_ns(system.now()))});
  auto lift = disturbance(3, msg::DisturbanceKind::DISTURBANCE_LIFT);
  system.disturb(lift);
  system.run_for(std::chrono::seconds(12));
  const Report report = system.metrics().report();
  CHECK(report.arrived == 2);
  REQUIRE(report.not_arrived.size() == 3);
  CHECK_THAT(report.not_arrived.at(0), StartsWith("no path leads to its goal; it goes to "));
  CHECK(report.not_arrived.at(2) == "an order holds it");
  CHECK(report.not_arrived.at(3) == "it is off the floor");
  CHECK_THAT(summary(report), ContainsSubstring("robot 0 has not arrived: no path leads to its goal; "));
}

}  // namespace sidestep::blocked_test
