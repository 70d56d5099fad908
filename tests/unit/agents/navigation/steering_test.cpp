// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/steering.hpp"

#include <algorithm>
#include <vector>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::steering_test {

constexpr MotionLimits kLimits;
constexpr double kRadius_m = 0.09, kMinSeparation_m = 0.19;
constexpr double kCycle_s = 1.0 / 60;

struct Mover {
  State state;
  Vec2 goal_m;
  Intent intent;
  Steering steering;
  LastChoice last{};

  Mover(const Vec2& start, const Vec2& goal, const Field& field)
      : state{start, Vec2::Zero()},
        goal_m(goal),
        intent{Vec2::Zero(), 0, goal, goal},
        steering(field, kRadius_m, kLimits) {}
};

/// Advances a state by one cycle according to an intent.
void advance(State& state, const Intent& intent) {
  const Vec2 to_go = intent.waypoint_m - state.position_m;
  const double length = to_go.norm() + (intent.goal_m - intent.waypoint_m).norm();
  const double braking = std::sqrt(2 * kLimits.deceleration_mps2 * 0.8 * length);
  const Vec2 ahead = std::min(kLimits.speed_mps, braking) * to_go.stableNormalized();
  Vec2 change = (intent.velocity_duration_s > 0 ? intent.velocity_mps : ahead) - state.velocity_mps;
  const double max_change_mps = kLimits.acceleration_mps2 * kCycle_s;
  if (change.norm() > max_change_mps) change *= max_change_mps / change.norm();
  state.position_m += kCycle_s * (state.velocity_mps + 0.5 * change);
  state.velocity_mps += change;
}

/// Runs a cycle: all robots choose intents one after another, then all robots move. Each robot uses its own
/// Steering unless `shared` is given.
void drive(std::vector<Mover>& movers, Steering* shared = nullptr) {
  for (Mover& mover : movers) {
    Steering& steering = shared ? *shared : mover.steering;
    steering.clear();
    for (const Mover& other : movers) {
      if (&other != &mover) steering.add_moving(other.state, other.intent, kMinSeparation_m);
    }
    mover.intent = steering.choose(mover.state, mover.goal_m, mover.goal_m, kCycle_s, mover.last);
  }
  for (Mover& mover : movers) advance(mover.state, mover.intent);
}

double nearest_m(const std::vector<Mover>& movers) {
  double nearest = 1e9;
  for (std::size_t i = 0; i < movers.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      nearest = std::min(nearest, (movers[i].state.position_m - movers[j].state.position_m).norm());
  }
  return nearest;
}

TEST_CASE("a lone robot heads straight for its waypoint") {
  const std::uint64_t seed = 3;
  CAPTURE(seed);
  Rng rng(seed);
  Steering steering(Field{}, kRadius_m, kLimits);
  LastChoice last;
  for (int i = 0; i < 100; ++i) {
    const double x = rng.uniform(-4, 4), y = rng.uniform(-2, 2);
    const Vec2 waypoint(rng.uniform(-4, 4), 0), goal(0, rng.uniform(-2, 2));
    const Intent intent = steering.choose({{x, y}, {0, 0}}, waypoint, goal, 1, last);
    CHECK(intent.velocity_duration_s == 0);
    CHECK(intent.waypoint_m == waypoint);
    CHECK(intent.goal_m == goal);
  }
}

TEST_CASE("two robots that meet head-on both turn right and pass") {
  std::vector<Mover> movers;
  movers.emplace_back(Vec2(-1.5, 0), Vec2(1.5, 0), Field{});
  movers.emplace_back(Vec2(1.5, 0), Vec2(-1.5, 0), Field{});
  double nearest = 1e9, passing_y_m = 0;
  int cycles = 0;
  while (movers[0].state.position_m.x() < 1.4 && cycles++ < 300) {
    drive(movers);
    nearest = std::min(nearest, nearest_m(movers));
    if (std::abs(movers[0].state.position_m.x()) < 0.1) passing_y_m = movers[0].state.position_m.y();
  }
  CHECK(cycles < 150);
  CHECK(nearest > kMinSeparation_m - 0.01);
  CHECK(passing_y_m < -0.02);
}

TEST_CASE("all robots of two groups that swap sides arrive") {
  const std::uint64_t seed = 5;
  CAPTURE(seed);
  Rng rng(seed);
  std::vector<Mover> movers;
  for (int i = 0; i < 5; ++i) {
    const double y = 0.5 * (i - 2);
    movers.emplace_back(Vec2(-1.5, y), Vec2(1.5, y), Field{});
    movers.emplace_back(Vec2(1.5, y + 0.1), Vec2(-1.5, y + 0.1), Field{});
  }
  double nearest = 1e9;
  const auto all_arrived = [&] {
    return std::ranges::all_of(movers,
                               [](const Mover& m) { return (m.state.position_m - m.goal_m).norm() < 0.1; });
  };
  int cycles = 0;
  while (!all_arrived() && cycles++ < 600) {
    drive(movers);
    nearest = std::min(nearest, nearest_m(movers));
  }
  CHECK(all_arrived());
  CHECK(cycles < 240);
  // Steering does not guarantee separation, so small violations are tolerated.
  CHECK(nearest > kMinSeparation_m - 0.05);
}

TEST_CASE("robots that share one Steering choose the same intents as robots with separate Steerings") {
  std::vector<Mover> apart;
  for (int i = 0; i < 12; ++i) {
    const Vec2 start = rotated(Vec2(1.5, 0), i * 0.5236);
    apart.emplace_back(start, -start, Field{});
  }
  std::vector<Mover> together = apart;
  Steering shared(Field{}, kRadius_m, kLimits);
  for (int cycle = 0; cycle < 200; ++cycle) {
    drive(apart);
    drive(together, &shared);
    for (std::size_t i = 0; i < apart.size(); ++i)
      REQUIRE(together[i].state.position_m == apart[i].state.position_m);
  }
  std::uint64_t changes = 0;
  for (std::size_t i = 0; i < apart.size(); ++i) {
    changes += apart[i].last.changes;
    CHECK(together[i].last.changes == apart[i].last.changes);
  }
  CHECK(changes > 0);
}

TEST_CASE("a robot passes a stationary obstacle without leaving the field") {
  const std::uint64_t seed = 6;
  CAPTURE(seed);
  Rng rng(seed);
  const Field field{4, 1};
  for (int round = 0; round < 50; ++round) {
    const double goal_y = rng.uniform(-0.4, 0.4), start_y = rng.uniform(-0.4, 0.4);
    Mover mover({-1.8, start_y}, {1.8, goal_y}, field);
    const double y = rng.uniform(-0.4, 0.4);
    const Vec2 obstacle(0, y);
    double nearest = 1e9;
    for (int cycle = 0; cycle < 300 && mover.state.position_m.x() < 1.5; ++cycle) {
      mover.steering.clear();
      mover.steering.add_stationary(obstacle, kMinSeparation_m);
      mover.intent = mover.steering.choose(mover.state, mover.goal_m, mover.goal_m, kCycle_s, mover.last);
      advance(mover.state, mover.intent);
      nearest = std::min(nearest, (mover.state.position_m - obstacle).norm());
      REQUIRE(std::abs(mover.state.position_m.y()) < field.width_m / 2 - kRadius_m + 0.05);
    }
    CAPTURE(round, y, nearest);
    CHECK(mover.state.position_m.x() > 1.4);
    CHECK(nearest > kMinSeparation_m - 0.03);
  }
}

TEST_CASE("a robot changes its detour around an obstacle only a few times") {
  Mover mover({-1.5, 0}, {1.5, 0}, Field{});
  double turned_m = 0;
  for (int cycle = 0; cycle < 300 && mover.state.position_m.x() < 1.4; ++cycle) {
    mover.steering.clear();
    mover.steering.add_stationary({0, 0.01}, kMinSeparation_m);
    mover.intent = mover.steering.choose(mover.state, mover.goal_m, mover.goal_m, kCycle_s, mover.last);
    advance(mover.state, mover.intent);
    turned_m = std::min(turned_m, mover.state.position_m.y());
  }
  CHECK(mover.state.position_m.x() >= 1.4);
  CHECK(turned_m < -0.1);
  // The robot changes to the detour, back to the direct path, and to a few better detours.
  CHECK(mover.last.changes >= 2);
  CHECK(mover.last.changes < 12);
}

}  // namespace sidestep::steering_test
