// SPDX-License-Identifier: Apache-2.0
// Robots that have arrived or have no order, where others cannot pass them.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <variant>

#include "agents/planning/named_planner.hpp"
#include "tests/bench/crowds/crowd_passages.hpp"
#include "tests/sim/disturbance.hpp"
#include "tests/sim/ordered_system.hpp"

namespace sidestep::step_aside_test {

using std::chrono::seconds;

constexpr double kBack_m = 0.02;
/// Robots that drive have goals at least this far from robots without orders.
constexpr double kFromGoals_m = 0.3;
constexpr std::uint64_t kScenes = 100;
/// A way counts as free if it is wider than necessary by this much on each side: robots at rest are not
/// exactly where they should be.
constexpr double kSpare_m = 0.005;

/// Robots that drive through a corridor, which is mostly too narrow for two, and in which robots without
/// orders rest.
Scenario corridor_scene(std::size_t resting, Rng& rng) {
  PassageSettings settings;
  settings.robots_per_side = 2;
  settings.width = {0.3, 0.6};
  settings.length = {0.6, 1.6};
  settings.max_shift_m = 0.3;
  Scenario scene = passage_scene(settings, {6, 3}, rng);
  const Box below = std::get<Box>(scene.obstacles.at(0)), above = std::get<Box>(scene.obstacles.at(1));
  const double lateral_m = (above.min_m.y() - below.max_m.y()) / 2 - scene.radius_m - 2 * scene.margin_m;
  const double middle_m = (above.min_m.y() + below.max_m.y()) / 2, half_m = below.max_m.x();
  for (std::size_t i = 0; i < resting; ++i) {
    RobotSpec& robot = scene.robots.at(i);
    const double along_m =
        resting == 1 ? rng.uniform(-half_m, half_m) : (i == 0 ? -1 : 1) * rng.uniform(0.15, half_m);
    robot.start_m = {along_m, middle_m + rng.uniform(-lateral_m, lateral_m)};
    robot.goals.clear();
  }
  return scene;
}

/// Robots that drive to other arms of a crossing of corridors, in which up to three without orders rest.
Scenario crossing_scene(Rng& rng) {
  Scenario scene = junction_scene({0.45, 0.7}, {4.8, 4.8}, rng);
  const std::size_t resting = 1 + rng.below(3);
  for (std::size_t i = 0; i < resting; ++i) scene.robots.at(i).goals.clear();
  const std::vector<RobotSpec> all = scene.robots;
  std::erase_if(scene.robots, [&](const RobotSpec& robot) {
    return !robot.goals.empty() && std::ranges::any_of(all, [&](const RobotSpec& other) {
      return other.goals.empty() && (other.start_m - robot.goals[0].position_m).norm() < kFromGoals_m;
    });
  });
  return scene;
}

/// Where the robot has to rest in the end: at its goal, or where it started.
Vec2 place_m(const RobotSpec& robot) {
  return robot.goals.empty() ? robot.start_m : robot.goals[0].position_m;
}

bool rests_at_place(const RobotSpec& robot, OrderedSystem& run) {
  const State& body = run.bodies[robot.id];
  return (body.position_m - place_m(robot)).norm() < kBack_m && body.velocity_mps.norm() < kAtRest_mps;
}

/// Whether no way leads from where a robot is to its place, past all other robots where they are.
bool is_locked_out(const Scenario& scene, const RobotSpec& robot, OrderedSystem& run) {
  const double required_m = scene.radius_m + scene.margin_m + kSpare_m;
  ObstacleWorld world{scene.obstacles};
  for (const RobotSpec& other : scene.robots)
    if (other.id != robot.id) world.add(Circle{run.bodies[other.id].position_m, scene.radius_m});
  const Vec2 from_m = run.bodies[robot.id].position_m;
  const auto planner = make_driving_planner("lazy-visibility");
  Rng rng(1);
  const DiscDomain domain(world, scene.field, required_m, from_m, place_m(robot),
                          planner.domain_settings(scene.field, scene.radius_m));
  return !planner.plan(domain, from_m, Budget{}, rng).arrives();
}

/// What became of all scenes.
struct Outcome {
  int moved = 0;        ///< number of robots without orders that have stepped aside
  int left = 0;         ///< number of robots that have left their goals for others
  int not_arrived = 0;  ///< number of robots that did not arrive although they could
  int not_back = 0;     ///< number of robots without orders that are not back although they could be
  // Numbers of robots that are not at their places because others rest in the way.
  int locked_out_with_order = 0, locked_out_without_order = 0;
  std::string failures;
};

template <typename Draw>
Outcome run_scenes(Draw draw) {
  Outcome outcome;
  for (std::uint64_t seed = 1; seed <= kScenes; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const Scenario scene = draw(rng);
    OrderedSystem run(scene, seed);
    run.system.run_for(seconds(1));
    std::set<RobotId> moved, arrived, left;
    run.run_until(seconds(60), [&] {
      for (const RobotSpec& robot : scene.robots)
        if (rests_at_place(robot, run))
          arrived.insert(robot.id);
        else if (robot.goals.empty())
          moved.insert(robot.id);
        else if (arrived.contains(robot.id))
          left.insert(robot.id);
      return std::ranges::all_of(scene.robots, [&](const RobotSpec& r) { return rests_at_place(r, run); });
    });
    outcome.moved += static_cast<int>(moved.size());
    outcome.left += static_cast<int>(left.size());
    for (const RobotSpec& robot : scene.robots) {
      if (rests_at_place(robot, run)) continue;
      outcome.failures +=
          fmt::format("seed {}: robot {} is at {:.2f},{:.2f}\n", seed, robot.id,
                      run.bodies[robot.id].position_m.x(), run.bodies[robot.id].position_m.y());
      if (is_locked_out(scene, robot, run))
        ++(robot.goals.empty() ? outcome.locked_out_without_order : outcome.locked_out_with_order);
      else
        ++(robot.goals.empty() ? outcome.not_back : outcome.not_arrived);
    }
    run.require_safe();
  }
  return outcome;
}

TEST_CASE("a robot without an order in a corridor steps aside, the others arrive, and it comes back",
          "[slow]") {
  const Outcome outcome = run_scenes([](Rng& rng) { return corridor_scene(1, rng); });
  INFO(outcome.failures);
  CHECK(outcome.not_arrived == 0);
  CHECK(outcome.not_back == 0);
  CHECK(outcome.locked_out_with_order == 0);
  CHECK(outcome.locked_out_without_order == 0);
  CHECK(outcome.moved > 30);
}

TEST_CASE("two robots without orders in a corridor step aside, the others arrive, and they come back",
          "[slow]") {
  const Outcome outcome = run_scenes([](Rng& rng) { return corridor_scene(2, rng); });
  INFO(outcome.failures);
  CHECK(outcome.not_arrived == 0);
  CHECK(outcome.not_back == 0);
  CHECK(outcome.locked_out_with_order == 0);
  CHECK(outcome.locked_out_without_order == 0);
  CHECK(outcome.moved > 60);
}

TEST_CASE("robots without orders at a crossing step aside, all others arrive, and they come back", "[slow]") {
  const Outcome outcome = run_scenes(crossing_scene);
  INFO(outcome.failures);
  CHECK(outcome.not_arrived == 0);
  CHECK(outcome.not_back == 0);
  CHECK(outcome.locked_out_with_order == 0);
  CHECK(outcome.locked_out_without_order == 0);
  CHECK(outcome.moved > 10);
}

/// A dead end for one robot at a time, and two robots that have goals in it. The one with the goal nearer to
/// the mouth is there first.
Scenario dead_end_scene(Rng& rng) {
  const double width_m = rng.uniform(0.225, 0.32), length_m = rng.uniform(0.7, 1.5);
  const double mouth_m = -3 + length_m, inner_m = -3 + rng.uniform(0.12, length_m - 0.55);
  const double outer_m = rng.uniform(inner_m + 0.25, mouth_m - 0.12);
  return parse_scenario(fmt::format("field: {{length_m: 6, width_m: 3}}\ntime_limit_s: 60\nobstacles:\n"
                                    "  - box: {{min_m: [-3, {}], max_m: [{}, 1.5]}}\n"
                                    "  - box: {{min_m: [-3, -1.5], max_m: [{}, {}]}}\nrobots:\n"
                                    "  - {{id: 0, start_m: [{}, {}], goals_m: [[{}, 0]]}}\n"
                                    "  - {{id: 1, start_m: [{}, {}], goals_m: [[{}, 0]]}}\n",
                                    width_m / 2, mouth_m, mouth_m, -width_m / 2,
                                    mouth_m + rng.uniform(0.3, 0.8), rng.uniform(-1.2, 1.2), outer_m,
                                    mouth_m + rng.uniform(1.5, 3), rng.uniform(-1.2, 1.2), inner_m),
                        "dead_end.yaml");
}

TEST_CASE("a robot near the mouth of a dead end lets another one in that has a goal behind it", "[slow]") {
  const Outcome outcome = run_scenes(dead_end_scene);
  INFO(outcome.failures);
  CHECK(outcome.not_arrived + outcome.locked_out_with_order == 0);
  CHECK(outcome.left > 50);
}

/// Goals in a packed hexagon of seven, and robots around them in any order.
Scenario packed_scene(Rng& rng) {
  const double spacing_m = 0.194 + rng.uniform(0.004, 0.03);
  std::vector<Vec2> goals_m{{0, 0}};
  for (int i = 0; i < 6; ++i)
    goals_m.push_back(spacing_m * Vec2(std::cos(i * M_PI / 3), std::sin(i * M_PI / 3)));
  const std::size_t first = rng.below(7);
  std::string text = "field: {length_m: 5, width_m: 3}\ntime_limit_s: 60\nrobots:\n";
  for (std::size_t i = 0; i < 7; ++i) {
    const Vec2& goal_m = goals_m[(first + 3 * i) % 7];
    const double angle = 0.9 * static_cast<double>(i) + rng.uniform(0, 0.6), radius_m = rng.uniform(0.8, 1.3);
    text += fmt::format("  - {{id: {}, start_m: [{}, {}], goals_m: [[{}, {}]]}}\n", i,
                        radius_m * std::cos(angle), radius_m * std::sin(angle), goal_m.x(), goal_m.y());
  }
  return parse_scenario(text, "packed.yaml");
}

TEST_CASE("robots with goals in a packed hexagon all arrive, whichever of them is there first", "[slow]") {
  const Outcome outcome = run_scenes(packed_scene);
  INFO(outcome.failures);
  CHECK(outcome.not_arrived + outcome.locked_out_with_order == 0);
  CHECK(outcome.left > 20);
}

/// A corridor along x for one robot at a time, and robots without goals.
Scenario corridor_with(const std::vector<Vec2>& starts_m) {
  std::string text =
      "field: {length_m: 6, width_m: 3}\ntime_limit_s: 60\nobstacles:\n"
      "  - box: {min_m: [-1.5, 0.2], max_m: [1.5, 1.5]}\n"
      "  - box: {min_m: [-1.5, -1.5], max_m: [1.5, -0.2]}\nrobots:\n";
  for (std::size_t i = 0; i < starts_m.size(); ++i)
    text += fmt::format("  - {{id: {}, start_m: [{}, {}]}}\n", i, starts_m[i].x(), starts_m[i].y());
  return parse_scenario(text, "corridor.yaml");
}

/// Checks that the last robot arrives in a scene of one block, around which lead two ways, with others at
/// rest. `stays`: the first of these must not move.
void check_arrives_around(const Box& block, const std::vector<Vec2>& resting_m, const Vec2& from_m,
                          const Vec2& to_m, double width_m, bool stays) {
  CAPTURE(block.max_m.x(), from_m.y(), width_m);
  std::string text = fmt::format(
      "field: {{length_m: {}, width_m: {}}}\ntime_limit_s: 60\nobstacles:\n"
      "  - box: {{min_m: [{}, {}], max_m: [{}, {}]}}\nrobots:\n",
      2 * block.max_m.x() + 2.4, width_m, block.min_m.x(), block.min_m.y(), block.max_m.x(), block.max_m.y());
  for (std::size_t i = 0; i < resting_m.size(); ++i)
    text += fmt::format("  - {{id: {}, start_m: [{}, {}]}}\n", i, resting_m[i].x(), resting_m[i].y());
  text += fmt::format("  - {{id: 9, start_m: [{}, {}]}}\n", from_m.x(), from_m.y());
  OrderedSystem run(parse_scenario(text, "ways.yaml"), 1);
  run.system.run_for(seconds(1));
  const auto order = run.send(msg::OrderKind::ORDER_GO, 9, kClient, {{to_m}});
  CHECK(run.run_until(seconds(30), [&] {
    if (stays) CHECK((run.bodies[0].position_m - resting_m[0]).norm() < kBack_m);
    return run.arrived.contains(order);
  }));
  run.require_safe();
}

TEST_CASE("a robot takes the other aisle if one is at rest far ahead in the shorter aisle") {
  for (const double half_m : {1.5, 3.0, 4.0}) {
    const Box block{{-half_m, -0.46}, {half_m, 0.14}};
    check_arrives_around(block, {{0, -0.6}}, {-half_m - 0.5, -0.6}, {half_m + 0.5, -0.6}, 1.48, true);
  }
}

TEST_CASE("if a robot without an order rests in each of two ways, one of them steps aside") {
  for (const double half_m : {1.0, 1.7, 2.4}) {
    const Box block{{-half_m, -0.2}, {half_m, 0.2}};
    check_arrives_around(block, {{0.7 * half_m, 0.45}, {-0.45 * half_m, -0.45}}, {-half_m - 0.5, 0},
                         {half_m + 0.5, 0}, 1.4, false);
  }
}

TEST_CASE("a robot steps aside for one that waits far away, where the way is wider") {
  Scenario scene = corridor_with({{1.7, 0.11}, {-2, 0.4}});
  scene.obstacles = {Box{{-1.5, -1.5}, {1.5, -0.133}}, Box{{-1.5, 0.133}, {1.5, 1.5}}};
  OrderedSystem run(scene, 1);
  run.system.run_for(seconds(1));
  const auto order = run.send(msg::OrderKind::ORDER_GO, 1, kClient, {{{2.5, 0.5}}});
  CHECK(run.run_until(seconds(30), [&] { return run.arrived.contains(order); }));
  run.require_safe();
}

TEST_CASE("a robot that has arrived steps aside for another one, and returns to its goal") {
  OrderedSystem run(corridor_with({{-2, 0}, {-2, 0.5}}), 1);
  run.system.run_for(seconds(1));
  const auto first = run.send(msg::OrderKind::ORDER_GO, 0, kClient, {{{0.5, 0}}});
  REQUIRE(run.run_until(seconds(10), [&] { return run.arrived.contains(first); }));
  const auto second = run.send(msg::OrderKind::ORDER_GO, 1, kClient, {{{2, 0.5}}});
  CHECK(run.run_until(seconds(20), [&] { return run.arrived.contains(second); }));
  CHECK(
      run.run_until(seconds(10), [&] { return (run.bodies[0].position_m - Vec2(0.5, 0)).norm() < kBack_m; }));
  run.require_safe();
}

TEST_CASE("a robot that has arrived leaves its goal for another one that has to go there, and returns") {
  const double beside_m = GENERATE(0.0, 0.1, 0.18);
  CAPTURE(beside_m);
  OrderedSystem run(corridor_with({{-2, 0}, {-2, 0.5}}), 1);
  run.system.run_for(seconds(1));
  const auto first = run.send(msg::OrderKind::ORDER_GO, 0, kClient, {{{2.2, 0}}});
  REQUIRE(run.run_until(seconds(10), [&] { return run.arrived.contains(first); }));
  const auto second = run.send(msg::OrderKind::ORDER_GO, 1, kClient, {{{2.2, beside_m}}, {{2.2, 1}}});
  CHECK(run.run_until(seconds(20), [&] { return run.arrived.contains(second); }));
  CHECK(
      run.run_until(seconds(10), [&] { return (run.bodies[0].position_m - Vec2(2.2, 0)).norm() < kBack_m; }));
  run.require_safe();
}

TEST_CASE("a robot does not step aside for one that a held robot blocks in any case") {
  OrderedSystem run(corridor_with({{0.3, 0}, {-2, 0.5}, {-0.6, 0}}), 1);
  run.system.run_for(seconds(1));
  run.send(msg::OrderKind::ORDER_HOLD, 2, kClient);
  run.send(msg::OrderKind::ORDER_GO, 1, kClient, {{{2, 0.5}}});
  CHECK_FALSE(
      run.run_until(seconds(15), [&] { return (run.bodies[0].position_m - Vec2(0.3, 0)).norm() > kBack_m; }));
  CHECK(run.statuses[1].order_state() == msg::OrderState::ORDER_BLOCKED);
}

TEST_CASE("a robot without an order that is lifted while it steps aside stays where it is put down") {
  OrderedSystem run(corridor_with({{0, 0}, {-2, 0.5}}), 1);
  const Vec2 put_down_m(-2.5, -1);
  run.system.run_for(seconds(1));
  const auto order = run.send(msg::OrderKind::ORDER_GO, 1, kClient, {{{2.5, 0.5}}});
  REQUIRE(run.run_until(seconds(15), [&] { return run.bodies[0].position_m.x() > 1; }));
  run.system.disturb(disturbance(0, msg::DisturbanceKind::DISTURBANCE_LIFT));
  run.system.run_for(seconds(1));
  msg::Disturbance place = disturbance(0, msg::DisturbanceKind::DISTURBANCE_PLACE);
  place.x_m(put_down_m.x());
  place.y_m(put_down_m.y());
  run.system.disturb(place);
  CHECK(run.run_until(seconds(15), [&] { return run.arrived.contains(order); }));
  run.system.run_for(seconds(5));
  CHECK((run.bodies[0].position_m - put_down_m).norm() < kBack_m);
}

TEST_CASE("a robot that is held does not step aside") {
  OrderedSystem run(corridor_with({{0, 0}, {-2, 0.5}}), 1);
  run.system.run_for(seconds(1));
  run.send(msg::OrderKind::ORDER_HOLD, 0, kClient);
  run.send(msg::OrderKind::ORDER_GO, 1, kClient, {{{2, 0.5}}});
  CHECK(run.run_until(seconds(15), [&] {
    const msg::OrderStatus& status = run.statuses[1];
    return status.order_state() == msg::OrderState::ORDER_BLOCKED && status.blocker() == 0;
  }));
  CHECK((run.bodies[0].position_m - Vec2(0, 0)).norm() < kBack_m);
  run.require_safe();
}

}  // namespace sidestep::step_aside_test
