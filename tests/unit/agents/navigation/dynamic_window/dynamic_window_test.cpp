// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/dynamic_window/dynamic_window.hpp"

#include <map>

#include "tests/catch.hpp"
#include "tests/unit/agents/navigation/dynamic_window/random_hull.hpp"

namespace sidestep::dynamic_window_test {

const ConvexPolygon kHull = pointed_hull();

DynamicWindowSettings settings_for(CollisionMethod method) {
  DynamicWindowSettings settings;
  settings.cell_m = 0.05;
  settings.method = method;
  return settings;
}

std::vector<Vec2> random_points(Rng& rng, std::size_t count, double half_side_m, const Hull& outside) {
  std::vector<Vec2> points;
  while (points.size() < count) {
    const Vec2 point = random_point(rng, half_side_m);
    if (!outside.contains(point)) points.push_back(point);
  }
  return points;
}

using Admissible = std::map<std::pair<int, int>, RatedWheelSpeeds>;

/// The admissible wheel speeds of a choice, by their indices in the grid of wheel speeds.
Admissible admissible_by_index(const WindowChoice& choice, const DifferentialDrive& drive) {
  const auto index = [&](double speed) {
    return static_cast<int>(std::lround(speed / drive.wheel_speed_mps * (kGridSide / 2))) + kGridSide / 2;
  };
  Admissible result;
  for (const RatedWheelSpeeds& rated : choice.admissible)
    result[{index(rated.wheels.left_mps), index(rated.wheels.right_mps)}] = rated;
  return result;
}

/// Slow reference: the velocities that are admissible while the robot drives, by definition.
Admissible reference(const DifferentialDrive& drive, const DynamicWindowSettings& settings,
                     const WindowQuery& query) {
  const Hull outline(padded(kHull, settings.padding_m));
  Admissible result;
  for (int row = 0; row < kGridSide; ++row) {
    for (int column = 0; column < kGridSide; ++column) {
      const double left = drive.wheel_speed_mps * (row - 20) / 20,
                   right = drive.wheel_speed_mps * (column - 20) / 20;
      const double change = drive.wheel_acceleration_mps2 * *query.window_s + 1e-9;
      if (std::abs(left - query.wheels.left_mps) > change ||
          std::abs(right - query.wheels.right_mps) > change)
        continue;
      const double v = (left + right) / 2, w = (right - left) / drive.wheel_base_m;
      if (std::abs(v) > drive.speed_mps + 1e-9 || std::abs(w) > drive.turn_rate_radps + 1e-9) continue;
      double time_s = settings.horizon_s;
      for (const Vec2& point : query.points_m)
        time_s = std::min(time_s, outline.time_to_collision_s(point, {v, w}));
      const double brake_s = std::max(std::abs(left), std::abs(right)) / drive.wheel_acceleration_mps2;
      if (time_s <= brake_s + query.cycle_s + 1e-6) continue;
      // The standstill pose by integration: one cycle at full speed, then constant deceleration.
      Vec2 rest(0, 0);
      double heading = 0;
      constexpr int kSteps = 4000;
      const double dt = (query.cycle_s + brake_s) / kSteps;
      for (int i = 0; i < kSteps; ++i) {
        const double t = (i + 0.5) * dt;
        const double fraction = t < query.cycle_s ? 1 : 1 - (t - query.cycle_s) / brake_s;
        rest += v * fraction * dt *
                Vec2(std::cos(heading + w * fraction * dt / 2), std::sin(heading + w * fraction * dt / 2));
        heading += w * fraction * dt;
      }
      const Vec2 off = query.goal.position_m - rest;
      const double angle =
          std::abs(std::remainder(std::atan2(off.y(), off.x()) - heading, 2 * std::numbers::pi));
      RatedWheelSpeeds rated{{left, right}, static_cast<float>(time_s), {}, 0};
      rated.objectives.distance = static_cast<float>((time_s - brake_s - query.cycle_s) /
                                                     (settings.horizon_s - brake_s - query.cycle_s));
      rated.objectives.heading = static_cast<float>(1 - angle / std::numbers::pi);
      rated.objectives.speed = static_cast<float>((v + drive.speed_mps) / (2 * drive.speed_mps));
      rated.value = static_cast<float>(settings.weights.distance) * rated.objectives.distance +
                    static_cast<float>(settings.weights.heading) * rated.objectives.heading +
                    static_cast<float>(settings.weights.speed) * rated.objectives.speed;
      result[{row, column}] = rated;
    }
  }
  return result;
}

TEST_CASE("the exact window agrees with a slow reference") {
  const DifferentialDrive drive;
  const DynamicWindowSettings settings = settings_for(CollisionMethod::kExact);
  DynamicWindow window(drive, kHull, settings);
  const Hull outline(padded(kHull, settings.padding_m));
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const std::vector<Vec2> points = random_points(rng, 5, 1.2, outline);
    WindowQuery query;
    query.points_m = points;
    query.wheels = {rng.uniform(-0.5, 0.5), rng.uniform(-0.5, 0.5)};
    query.goal.position_m = {2, 0.1};  // the goal is ahead, so the robot drives
    query.window_s = seed % 3 == 0 ? 10 : 0.2;
    const WindowChoice& choice = window.choose(query);
    CHECK(choice.state == DriveState::kGo);
    const Admissible found = admissible_by_index(choice, drive), expected = reference(drive, settings, query);
    REQUIRE(found.size() == choice.admissible.size());
    REQUIRE(found.size() == expected.size());
    float best = -1;
    for (const auto& [index, rated] : expected) {
      REQUIRE(found.count(index) == 1);
      const RatedWheelSpeeds& ours = found.at(index);
      CHECK(ours.time_to_collision_s == Approx(rated.time_to_collision_s).margin(1e-5));
      CHECK(ours.objectives.distance == Approx(rated.objectives.distance).margin(1e-4));
      CHECK(ours.objectives.heading == Approx(rated.objectives.heading).margin(1e-4));
      CHECK(ours.objectives.speed == Approx(rated.objectives.speed).margin(1e-5));
      CHECK(ours.value == Approx(rated.value).margin(1e-4));
      best = std::max(best, rated.value);
    }
    REQUIRE(choice.best.has_value() == !expected.empty());
    if (choice.best) {
      CHECK(choice.admissible[*choice.best].value == Approx(best).margin(1e-4));
      CHECK(choice.command.left_mps == choice.admissible[*choice.best].wheels.left_mps);
    }
  }
}

TEST_CASE("tables admit most of the admissible velocities and no others") {
  const DifferentialDrive drive;
  DynamicWindow exact(drive, kHull, settings_for(CollisionMethod::kExact));
  DynamicWindow tables[] = {{drive, kHull, settings_for(CollisionMethod::kUniformTable)},
                            {drive, kHull, settings_for(CollisionMethod::kLloydMaxTable)}};
  const Hull outline(padded(kHull, 0.02));
  std::size_t admitted_exactly = 0, admitted[2] = {};
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    // Some points lie within a cell's length of the hull, and tables omit their cells.
    const std::vector<Vec2> points = random_points(rng, 8, seed % 2 == 0 ? 0.5 : 1.2, outline);
    WindowQuery query;
    query.points_m = points;
    query.wheels = {rng.uniform(-0.5, 0.5), rng.uniform(-0.5, 0.5)};
    query.goal.position_m = {2, 0};
    query.window_s = 10;
    const Admissible expected = admissible_by_index(exact.choose(query), drive);
    admitted_exactly += expected.size();
    for (std::size_t i = 0; i < 2; ++i) {
      for (const auto& [index, rated] : admissible_by_index(tables[i].choose(query), drive)) {
        REQUIRE(expected.count(index) == 1);
        REQUIRE(rated.time_to_collision_s <= expected.at(index).time_to_collision_s + 1e-6F);
        ++admitted[i];
      }
    }
  }
  CHECK(admitted_exactly > 1000);
  for (const std::size_t count : admitted) CHECK(count > admitted_exactly * 3 / 4);
}

TEST_CASE("a point inside the padded hull makes the robot brake") {
  const DifferentialDrive drive;
  for (const CollisionMethod method : {CollisionMethod::kExact, CollisionMethod::kUniformTable}) {
    DynamicWindow window(drive, kHull, settings_for(method));
    const Vec2 inside(0.31, 0);  // outside the hull, but not outside its padding
    WindowQuery query;
    query.points_m = {&inside, 1};
    query.wheels = {0.4, 0.2};
    query.goal.position_m = {2, 0};
    const WindowChoice& choice = window.choose(query);
    CHECK(choice.is_touching);
    CHECK(choice.admissible.empty());
    CHECK_FALSE(choice.best);
    // Both wheels slow down in proportion, so the robot stays on its arc.
    CHECK(choice.command.left_mps == Approx(0.4 - 0.0572));
    CHECK(choice.command.right_mps == Approx(choice.command.left_mps / 2));
  }
}

TEST_CASE("points within a cell of the hull block only motions that run into them") {
  const DifferentialDrive drive;
  DynamicWindow window(drive, kHull, settings_for(CollisionMethod::kUniformTable));
  // The posts stand on both sides of the robot, 15 mm from the padded hull.
  const std::vector<Vec2> posts{{0, -0.235}, {0, 0.235}};
  for (const Vec2& post : posts)
    CHECK_FALSE(window.table()->time_s(*window.table()->grid().cell_of(post), 0));
  WindowQuery query;
  query.points_m = posts;
  query.goal.position_m = {2, 0};
  query.window_s = 1;
  const WindowChoice& choice = window.choose(query);
  CHECK_FALSE(choice.is_touching);
  REQUIRE(choice.best);
  CHECK(drive.motion(choice.command).speed_mps > 0.4);
  // Turning on the spot would move the corners into the posts.
  for (const RatedWheelSpeeds& rated : choice.admissible) {
    const ArcMotion motion = drive.motion(rated.wheels);
    if (std::abs(motion.speed_mps) < 0.01) CHECK(std::abs(motion.turn_rate_radps) < 1);
  }
}

TEST_CASE("a robot that must turn on the spot does not drive forward") {
  const DifferentialDrive drive;
  DynamicWindow window(drive, kHull, settings_for(CollisionMethod::kExact));
  WindowQuery query;
  query.goal.position_m = {0, 2};
  const WindowChoice* choice = &window.choose(query);
  CHECK(choice->state == DriveState::kTurn);
  REQUIRE(choice->best);
  for (const RatedWheelSpeeds& rated : choice->admissible)
    CHECK(drive.motion(rated.wheels).speed_mps == Approx(0).margin(1e-12));
  CHECK(drive.motion(choice->command).turn_rate_radps > 0.1);
  query.goal = {{0.01, 0}, -2.0, 0.1};
  choice = &window.choose(query);
  CHECK(choice->state == DriveState::kAlign);
  REQUIRE(choice->best);
  CHECK(drive.motion(choice->command).speed_mps == Approx(0).margin(1e-12));
  CHECK(drive.motion(choice->command).turn_rate_radps < -0.1);
}

TEST_CASE("dynamic windows refuse invalid settings and queries") {
  const DifferentialDrive drive;
  DynamicWindowSettings settings = settings_for(CollisionMethod::kExact);
  settings.weights = {0, 0, 0};
  CHECK_THROWS_AS(DynamicWindow(drive, kHull, settings), std::invalid_argument);
  settings = settings_for(CollisionMethod::kExact);
  settings.horizon_s = 0;
  CHECK_THROWS_AS(DynamicWindow(drive, kHull, settings), std::invalid_argument);
  DynamicWindow window(drive, kHull, settings_for(CollisionMethod::kExact));
  WindowQuery query;
  query.cycle_s = 0;
  CHECK_THROWS_AS(window.choose(query), std::invalid_argument);
  query = {};
  query.wheels.left_mps = std::nan("");
  CHECK_THROWS_AS(window.choose(query), std::invalid_argument);
  query = {};
  query.goal.radius_m = 0;
  CHECK_THROWS_AS(window.choose(query), std::invalid_argument);
}

}  // namespace sidestep::dynamic_window_test
