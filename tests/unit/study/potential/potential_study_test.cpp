// SPDX-License-Identifier: Apache-2.0
#include "tests/study/potential/potential_study.hpp"

#include <fstream>

#include "tests/catch.hpp"
#include "tests/study/potential/field_method.hpp"
#include "tests/study/potential/field_scene.hpp"
#include "tests/unit/study/study_files.hpp"

namespace sidestep::potential_study_test {

TEST_CASE("the quick study of potential fields shows minima and oscillation that E* does not have") {
  StudyFolder folder;
  StudyOptions options;
  options.folder = folder.path();
  options.seed = 3;
  options.is_quick = true;
  REQUIRE(study_potential(options) == 0);
  const auto minima = folder.table("potential", "minima", 3);
  CHECK(minima.size() == 30);
  for (const char* scene : {"U", "wall", "corridor", "gap", "discs"}) {
    CAPTURE(scene);
    const auto of = [&](const char* method, const char* column) {
      return number_in(minima, {{"scene", scene}, {"method", method}}, column);
    };
    CHECK(of("E*", "arrived_percent") == 100);
    CHECK(of("NF1", "arrived_percent") == 100);
    CHECK(of("E*", "reversals_per_m") < 0.5);
  }
  CHECK(number_in(minima, {{"scene", "U"}, {"method", "potential"}}, "minimum_percent") == 100);
  const auto corridors = folder.table("potential", "oscillation", 3);
  const auto reversals = [&](const char* spare_m, const char* method) {
    return number_in(corridors, {{"spare_m", spare_m}, {"method", method}}, "reversals_per_m");
  };
  CHECK(reversals("0.2", "potential") > 5);
  CHECK(reversals("0.2", "potential") > reversals("0.6", "potential"));
  CHECK(folder.has_png("minima"));
  CHECK(folder.has_png("oscillation"));
  std::ifstream picture(folder.path() + "/trap.svg");
  std::string begin;
  picture >> begin;
  CHECK(begin == "<svg");
}

PlanWorld open_world() {
  PlanWorld world;
  world.field = {8, 5};
  world.queries = {{{-2, 0.3}, {2, -0.1}}};
  return world;
}

TEST_CASE("a drive ends at the goal, at a contact, in a local minimum or at the time limit") {
  const PlanWorld open = open_world();
  const ObstacleWorld nothing;
  const Vec2 goal = open.queries[0].goal_m;
  const DriveDirection straight = [&](const Vec2& at) -> Vec2 { return (goal - at).normalized(); };
  const FieldDrive arrives = drive_by_direction(straight, open, nothing);
  CHECK(arrives.end == DriveEnd::kArrived);
  CHECK(arrives.reversals == 0);
  // The robot drives at 0.5 m/s and needs at most an additional second to accelerate and brake.
  CHECK(arrives.seconds > arrives.length_m / 0.5);
  CHECK(arrives.seconds < arrives.length_m / 0.5 + 1);
  for (std::size_t i = 1; i < arrives.path_m.size(); ++i)
    REQUIRE((arrives.path_m[i] - arrives.path_m[i - 1]).norm() < 0.5 / 60 + 1e-9);
  CHECK(drive_by_direction(straight, open, ObstacleWorld({Circle{{0, 0.1}, 0.2}})).end == DriveEnd::kContact);
  const DriveDirection nowhere = [](const Vec2&) -> Vec2 { return {0, 0}; };
  CHECK(drive_by_direction(nowhere, open, nothing).end == DriveEnd::kLocalMinimum);
  const DriveDirection round = [](const Vec2& at) -> Vec2 { return left_of(at).normalized(); };
  PlanWorld far = open;
  far.queries[0].goal_m = {3.5, 0};
  CHECK(drive_by_direction(round, far, nothing).end == DriveEnd::kTimeLimit);
}

TEST_CASE("every method drives straight if there is no obstacle") {
  using Kind = FieldMethod::Kind;
  const PlanWorld open = open_world();
  const ObstacleWorld nothing;
  for (const FieldMethod& method :
       {FieldMethod{Kind::kPotential, 0}, FieldMethod{Kind::kPotential, 2}, FieldMethod{Kind::kEStar, 0}}) {
    CAPTURE(name_of(method));
    const FieldDrive drive = drive_by_direction(direction_of(method, open, nothing), open, nothing);
    CHECK(drive.end == DriveEnd::kArrived);
    CHECK(drive.length_m < 1.01 * (open.queries[0].goal_m - open.queries[0].start_m).norm());
  }
}

TEST_CASE("scenes of the potential study depend on the seed") {
  for (const FieldScene scene : kFieldScenes) {
    CAPTURE(name_of(scene));
    const PlanWorld first = field_scene(scene, 5), second = field_scene(scene, 5),
                    other = field_scene(scene, 6);
    CHECK(first.queries[0].start_m == second.queries[0].start_m);
    CHECK(first.queries[0].start_m != other.queries[0].start_m);
    REQUIRE(first.obstacles.size() == second.obstacles.size());
    for (std::size_t i = 0; i < first.obstacles.size(); ++i)
      CHECK(centre_m(first.obstacles[i]) == centre_m(second.obstacles[i]));
    CHECK(is_free(first, first.queries[0].start_m));
    CHECK(is_free(first, first.queries[0].goal_m));
  }
}

}  // namespace sidestep::potential_study_test
