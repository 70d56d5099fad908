// SPDX-License-Identifier: Apache-2.0
#include "deploy/evaluation/study/corners/corner_study.hpp"

#include "common/collision/obstacle_world.hpp"
#include "deploy/evaluation/study/corners/corner_scene.hpp"
#include "tests/catch.hpp"
#include "tests/unit/deploy/evaluation/study/study_files.hpp"

namespace sidestep::corner_study_test {

TEST_CASE("the quick study of corners finds no robot that moves when it is touched") {
  StudyFolder folder;
  StudyOptions options;
  options.folder = folder.path();
  options.seed = 3;
  options.is_quick = true;
  REQUIRE(study_corners(options) == 0);
  const auto rows = folder.table("corners", "corners", 3);
  CHECK(rows.size() == kCornerKinds.size());
  for (const StudyRow& row : rows) {
    CAPTURE(row.at("kind"));
    CHECK(row.at("cases") == "2");
    CHECK(row.at("contacts") == "0");
    CHECK(row.at("crashes_in_motion") == "0");
    CHECK(row.at("failed_audits") == "0");
  }
  CHECK(folder.has_png("corners"));
}

TEST_CASE("in scenes of corners people walk through no obstacle, and the robot does not see its goal") {
  for (std::size_t kind = 0; kind < kCornerKinds.size(); ++kind) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      CAPTURE(kCornerKinds[kind], seed);
      const Scenario scenario = corner_scene(kind, seed);
      std::vector<Shape> shapes = scenario.obstacles;
      if (scenario.map)
        for (const Box& box : scenario.map->rectangles()) shapes.emplace_back(box);
      const ObstacleWorld world(shapes);
      REQUIRE(scenario.robots.size() == 1);
      REQUIRE_FALSE(scenario.opponents.empty());
      const Vec2& start = scenario.robots[0].start_m;
      CHECK(world.touches(start, scenario.robots[0].goals.back().position_m, 0));
      for (const OpponentSpec& person : scenario.opponents) {
        CHECK(person.radius_m >= scenario.laser->person_radius_m);
        CHECK(person.speed_mps <= scenario.max_opponent_speed_mps);
        CHECK((person.path_m.front() - start).norm() > 0.9);
        for (std::size_t i = 1; i < person.path_m.size(); ++i)
          CHECK_FALSE(world.touches(person.path_m[i - 1], person.path_m[i], person.radius_m - 1e-6));
      }
    }
  }
}

}  // namespace sidestep::corner_study_test
