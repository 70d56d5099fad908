// SPDX-License-Identifier: Apache-2.0
#include "tests/study/joint_planning/joint_planning_study.hpp"

#include "tests/catch.hpp"
#include "tests/study/joint_planning/joint_scene.hpp"
#include "tests/unit/study/study_files.hpp"

namespace sidestep::joint_planning_study_test {

TEST_CASE("every method solves the scenes of the quick joint-planning study without faults") {
  StudyFolder folder;
  StudyOptions options;
  options.folder = folder.path();
  options.seed = 3;
  options.is_quick = true;
  REQUIRE(study_joint_planning(options) == 0);
  for (const char* name : {"swap", "circle"}) {
    CAPTURE(name);
    const auto rows = folder.table("explicit", name, 3);
    CHECK(rows.size() == 6);
    for (const StudyRow& row : rows) {
      CAPTURE(row);
      CHECK(row.at("solved_percent") == "100.0");
      CHECK(row.at("faults") == "0");
      CHECK(std::stod(row.at("makespan")) > 1);
      CHECK(std::stod(row.at("plan_us")) > 0);
    }
    CHECK(folder.has_png(name));
  }
}

TEST_CASE("joint scenes depend on the seed, and robots begin and end clear of each other and of obstacles") {
  const JointScene scene = GENERATE(JointScene::kSwap, JointScene::kCircle);
  const int robots = GENERATE(2, 8, 16);
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    CAPTURE(name_of(scene), robots, seed);
    const Scenario scenario = joint_scene(scene, robots, seed), again = joint_scene(scene, robots, seed);
    const ObstacleWorld world(scenario.obstacles);
    const JointProblem problem = joint_problem(scenario, world);
    REQUIRE(problem.robots() == static_cast<std::size_t>(robots));
    CHECK(joint_problem(again, world).starts_m == problem.starts_m);
    CHECK(joint_problem(again, world).goals_m == problem.goals_m);
    const double clear_m = problem.distance_from_obstacles_m() + 0.01;
    for (const std::vector<Vec2>& places : {problem.starts_m, problem.goals_m})
      for (std::size_t i = 0; i < places.size(); ++i) {
        REQUIRE(problem.field.contains(places[i], clear_m));
        for (const Shape& obstacle : scenario.obstacles)
          REQUIRE(signed_distance(places[i], obstacle) > clear_m);
        for (std::size_t j = 0; j < i; ++j)
          REQUIRE((places[i] - places[j]).norm() > problem.min_separation_m() + 0.01);
      }
  }
  const ObstacleWorld world;
  const auto starts = [&](std::uint64_t seed) {
    const Scenario scenario = joint_scene(JointScene::kCircle, robots, seed);
    return joint_problem(scenario, world).starts_m;
  };
  CHECK(starts(1) != starts(2));
  CHECK_THROWS_AS(joint_scene(scene, 3, 1), std::invalid_argument);
  CHECK_THROWS_AS(joint_scene(scene, 0, 1), std::invalid_argument);
}

}  // namespace sidestep::joint_planning_study_test
