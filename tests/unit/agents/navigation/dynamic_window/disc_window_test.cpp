// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/dynamic_window/disc_window.hpp"

#include "common/motion/robot_model.hpp"
#include "tests/catch.hpp"
#include "tests/unit/agents/navigation/dynamic_window/random_hull.hpp"

namespace sidestep::disc_window_test {

constexpr double kRadius_m = 0.09, kCycle_s = 1.0 / 60;
const MotionLimits kLimits;

DiscWindowSettings settings_for(CollisionMethod method) {
  DiscWindowSettings settings;
  settings.cell_m = 0.06;
  settings.method = method;
  return settings;
}

std::vector<Vec2> random_points(Rng& rng, std::size_t count) {
  std::vector<Vec2> points;
  while (points.size() < count) {
    const Vec2 point = random_point(rng, 1);
    if (point.norm() > kRadius_m) points.push_back(point);
  }
  return points;
}

TEST_CASE("a disc may choose exactly the velocities that it can reach and stop from") {
  DiscWindow exact(kRadius_m, kLimits, settings_for(CollisionMethod::kExact));
  DiscWindow table(kRadius_m, kLimits, settings_for(CollisionMethod::kUniformTable));
  std::size_t by_exact = 0, by_table = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const std::vector<Vec2> points = random_points(rng, 6);
    DiscWindowQuery query;
    query.points_m = points;
    query.velocity_mps = random_point(rng, 1.4);
    query.goal_m = random_point(rng, 3);
    query.cycle_s = kCycle_s;
    query.window_s = seed % 2 == 0 ? 0.2 : 5;
    std::vector<Vec2> expected;
    for (int i = -20; i <= 20; ++i) {
      for (int j = -20; j <= 20; ++j) {
        const Vec2 v = kLimits.speed_mps / 20 * Vec2(i, j);
        if (v.norm() > kLimits.speed_mps + 1e-9) continue;
        if (!is_admissible((v - query.velocity_mps) / *query.window_s, query.velocity_mps, kLimits)) continue;
        // The path at constant speed for one cycle and the braking time, longer than the actual path.
        const Segment path{Vec2(0, 0), v * (v.norm() / kLimits.deceleration_mps2 + kCycle_s)};
        const bool is_free = std::ranges::all_of(
            points, [&](const Vec2& p) { return squared_distance(p, path) > kRadius_m * kRadius_m; });
        if (is_free) expected.push_back(v);
      }
    }
    const DiscWindowChoice& choice = exact.choose(query);
    REQUIRE(choice.admissible.size() == expected.size());
    for (const Vec2& v : expected) {
      REQUIRE(std::ranges::any_of(choice.admissible, [&](const RatedVelocity& rated) {
        return (rated.velocity_mps - v).norm() < 1e-9;
      }));
    }
    for (std::size_t i = 1; i < choice.admissible.size(); ++i)
      REQUIRE(choice.admissible[i - 1].value >= choice.admissible[i].value);
    by_exact += choice.admissible.size();
    for (const RatedVelocity& rated : table.choose(query).admissible) {
      ++by_table;
      REQUIRE(std::ranges::any_of(expected,
                                  [&](const Vec2& v) { return (rated.velocity_mps - v).norm() < 1e-9; }));
    }
  }
  CHECK(by_exact > 1000);
  CHECK(by_table > by_exact * 3 / 4);
}

TEST_CASE("without obstacles, the best velocity is the fastest one towards the goal") {
  DiscWindow window(kRadius_m, kLimits, settings_for(CollisionMethod::kExact));
  DiscWindowQuery query;
  query.goal_m = {3, 4};
  query.window_s = 10;
  const DiscWindowChoice& choice = window.choose(query);
  REQUIRE_FALSE(choice.admissible.empty());
  CHECK((choice.admissible[0].velocity_mps - Vec2(1.2, 1.6)).norm() < 1e-9);
}

TEST_CASE(
    "if a cycle is too short to reach another grid velocity, the grid velocities around the current one are "
    "considered") {
  DiscWindow window(kRadius_m, kLimits, settings_for(CollisionMethod::kExact));
  DiscWindowQuery query;
  query.velocity_mps = {0.55, -0.25};
  query.goal_m = {3, 0};
  query.cycle_s = 0.001;
  const DiscWindowChoice& choice = window.choose(query);
  CHECK(choice.admissible.size() == 4);
  for (const RatedVelocity& rated : choice.admissible)
    CHECK((rated.velocity_mps - query.velocity_mps).cwiseAbs().maxCoeff() < 0.051);
}

TEST_CASE("a disc with a point inside has no admissible velocity") {
  for (const CollisionMethod method : {CollisionMethod::kExact, CollisionMethod::kLloydMaxTable}) {
    DiscWindow window(kRadius_m, kLimits, settings_for(method));
    const Vec2 inside(0.05, 0.05);
    DiscWindowQuery query;
    query.points_m = {&inside, 1};
    const DiscWindowChoice& choice = window.choose(query);
    CHECK(choice.is_touching);
    CHECK(choice.admissible.empty());
  }
}

TEST_CASE("a disc among random posts reaches most goals and touches nothing") {
  DiscWindow window(kRadius_m, kLimits, settings_for(CollisionMethod::kUniformTable));
  int arrived = 0;
  constexpr int kRuns = 20;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    std::vector<Vec2> posts;
    while (posts.size() < 12) posts.emplace_back(rng.uniform(0.4, 2.6), rng.uniform(-1, 1));
    Vec2 position(0, 0), velocity(0, 0);
    const Vec2 goal(3, 0);
    bool is_there = false;
    for (int cycle = 0; cycle < 600 && !is_there; ++cycle) {
      std::vector<Vec2> points;
      for (const Vec2& post : posts) points.push_back(post - position);
      DiscWindowQuery query;
      query.points_m = points;
      query.velocity_mps = velocity;
      query.goal_m = goal - position;
      query.cycle_s = kCycle_s;
      query.window_s = 0.1;
      const DiscWindowChoice& choice = window.choose(query);
      REQUIRE_FALSE(choice.is_touching);
      // Without an admissible velocity the robot brakes in a straight line, which every chosen velocity
      // permits.
      const double speed = velocity.norm();
      const double after = std::max(0.0, speed - kLimits.deceleration_mps2 * kCycle_s);
      if (!choice.admissible.empty())
        velocity = choice.admissible[0].velocity_mps;
      else
        velocity = speed > 0 ? Vec2(after / speed * velocity) : Vec2(0, 0);
      const Segment path{position, position + kCycle_s * velocity};
      position = path.to_m;
      for (const Vec2& post : posts) REQUIRE(squared_distance(post, path) > kRadius_m * kRadius_m);
      is_there = (position - goal).norm() < 0.1;
    }
    arrived += is_there ? 1 : 0;
  }
  // The method is local, so some robots get stuck.
  CHECK(arrived >= kRuns / 2);
}

TEST_CASE("disc windows refuse invalid settings and queries") {
  CHECK_THROWS_AS(DiscWindow(0, kLimits), std::invalid_argument);
  CHECK_THROWS_AS(DiscWindow(kRadius_m, {.acceleration_mps2 = 0}), std::invalid_argument);
  DiscWindow window(kRadius_m, kLimits, settings_for(CollisionMethod::kExact));
  DiscWindowQuery query;
  query.cycle_s = -1;
  CHECK_THROWS_AS(window.choose(query), std::invalid_argument);
  query = {};
  query.goal_m.x() = std::nan("");
  CHECK_THROWS_AS(window.choose(query), std::invalid_argument);
}

}  // namespace sidestep::disc_window_test
