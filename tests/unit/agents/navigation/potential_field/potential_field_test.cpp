// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/potential_field/potential_field.hpp"

#include "tests/catch.hpp"
#include "tests/unit/agents/navigation/dynamic_window/random_hull.hpp"

namespace sidestep::potential_field_test {

constexpr double kRadius_m = 0.1;

ObstaclePoints obstacles_of(std::span<const Vec2> points) {
  ObstaclePoints result;
  result.set(points, {0, 0});
  return result;
}

/// A wall of points.
void add_wall(const Vec2& from, const Vec2& to, std::vector<Vec2>& points) {
  for (int i = 0; i <= 200; ++i) points.push_back(from + i / 200.0 * (to - from));
}

TEST_CASE("without rotation, the force is the negative gradient of the potential") {
  int repelled = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const PotentialField field(kRadius_m, {.reach_m = 0.8});
    const Vec2 at = random_point(rng, 1), goal = random_point(rng, 3), post = random_point(rng, 1);
    const auto free = [&](const Vec2& p) { return FreeDistance{(p - post).norm(), (p - post).normalized()}; };
    if (free(at).distance_m < kRadius_m + 0.05) continue;
    if (free(at).distance_m < kRadius_m + 0.8) ++repelled;
    constexpr double kStep_m = 1e-5;
    const auto slope = [&](const Vec2& by) {
      return (field.potential(at + by, goal, free(at + by)) - field.potential(at - by, goal, free(at - by))) /
             (2 * kStep_m);
    };
    const Vec2 gradient(slope({kStep_m, 0}), slope({0, kStep_m}));
    CHECK((field.force(at, goal, free(at)) + gradient).norm() < 1e-4 * (1 + gradient.norm()));
  }
  CHECK(repelled > 100);
}

TEST_CASE("a robot descends around a post to its goal") {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const std::vector<Vec2> post{{1, rng.uniform(0.02, 0.3)}};
    PotentialField field(kRadius_m);
    const Descent& descent = field.descend({0, 0}, {2, 0}, obstacles_of(post), 5000);
    REQUIRE(descent.end == DescentEnd::kArrived);
    for (const Vec2& at : descent.path_m) REQUIRE((at - post[0]).norm() > kRadius_m);
  }
}

TEST_CASE("a robot in a U-shaped obstacle gets stuck in a local minimum, which is reported") {
  //      +------+
  //  robot →    |    goal
  //      +------+
  std::vector<Vec2> points;
  add_wall({0, 0.5}, {1, 0.5}, points);
  add_wall({1, 0.5}, {1, -0.5}, points);
  add_wall({1, -0.5}, {0, -0.5}, points);
  PotentialField field(kRadius_m);
  const Descent& descent = field.descend({-0.5, 0.05}, {2, 0}, obstacles_of(points), 20'000);
  CHECK(descent.end == DescentEnd::kLocalMinimum);
  const Vec2 end = descent.path_m.back();
  CHECK(end.x() > 0);
  CHECK(end.x() < 1 - kRadius_m);
  CHECK(std::abs(end.y()) < 0.5 - kRadius_m);
  // The forces cancel where the robot is stuck: the goal's force alone would be above 1.
  const ObstaclePoints free = obstacles_of(points);
  CHECK(field.force(end, {2, 0}, free(end, 0)).norm() < 0.5);
}

TEST_CASE("a rotational field leads around a wall at which the plain field gets stuck") {
  std::vector<Vec2> points;
  add_wall({1, 0.3}, {1, -0.3}, points);
  PotentialField plain(kRadius_m), rotational(kRadius_m, {.rotation = 1});
  CHECK(plain.descend({0, 0}, {2, 0}, obstacles_of(points), 20'000).end == DescentEnd::kLocalMinimum);
  const Descent& around = rotational.descend({0, 0}, {2, 0}, obstacles_of(points), 20'000);
  CHECK(around.end == DescentEnd::kArrived);
}

TEST_CASE("a descent ends at a contact or when its steps are used up") {
  const std::vector<Vec2> post{{0.05, 0}};
  PotentialField field(kRadius_m);
  CHECK(field.descend({0, 0}, {2, 0}, obstacles_of(post), 100).end == DescentEnd::kTouching);
  CHECK(field.descend({0, 0}, {2, 0}, obstacles_of({}), 10).end == DescentEnd::kStepsSpent);
  CHECK(field.descend({0, 0}, {2, 0}, obstacles_of({}), 1000).end == DescentEnd::kArrived);
}

TEST_CASE("potential fields refuse invalid settings") {
  CHECK_THROWS_AS(PotentialField(-1), std::invalid_argument);
  CHECK_THROWS_AS(PotentialField(kRadius_m, {.reach_m = 0}), std::invalid_argument);
}

}  // namespace sidestep::potential_field_test
