// SPDX-License-Identifier: Apache-2.0
#include "tests/study/corners/corner_study.hpp"

#include "common/collision/obstacle_world.hpp"
#include "tests/catch.hpp"
#include "tests/study/corners/corner_scene.hpp"
#include "tests/study/corners/doorway_scene.hpp"
#include "tests/unit/study/study_files.hpp"

namespace sidestep::corner_study_test {

TEST_CASE("in the quick study of corners no robot moves when it is touched") {
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

TEST_CASE("in the quick study of doorways no robot moves when it is touched") {
  StudyFolder folder;
  StudyOptions options;
  options.folder = folder.path();
  options.seed = 3;
  options.is_quick = true;
  REQUIRE(study_doorways(options) == 0);
  const auto rows = folder.table("doorways", "doorways", 3);
  CHECK(rows.size() == kDoorwayKinds.size());
  for (const StudyRow& row : rows) CHECK(row.at("crashes_in_motion") == "0");
}

TEST_CASE("in doorway scenes people do not walk through walls, many hardly fit, and all step out") {
  int tight = 0, people = 0;
  for (std::size_t kind = 0; kind < kDoorwayKinds.size(); ++kind) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      CAPTURE(kDoorwayKinds[kind], seed);
      const Scenario scenario = doorway_scene(kind, seed);
      const OccupancyMap& map = scenario.map->cells();
      for (const OpponentSpec& person : scenario.opponents) {
        ++people;
        CHECK(person.radius_m >= scenario.laser->person_radius_m);
        CHECK(person.speed_mps <= scenario.max_opponent_speed_mps);
        double nearest_m = 1;
        for (std::size_t i = 1; i < person.path_m.size(); ++i) {
          CHECK_FALSE(map.touches(person.path_m[i - 1], person.path_m[i], person.radius_m - 1e-6));
          nearest_m = std::min(nearest_m, map.distance_m(person.path_m[i], 1));
        }
        tight += nearest_m < person.radius_m + 0.03;
        // The walk ends in the corridor.
        CHECK(person.path_m.back().y() < person.path_m.front().y() - 0.1);
      }
    }
  }
  CHECK(people > 100);
  CHECK(tight > people / 4);
}

TEST_CASE("in corner scenes people do not walk through obstacles, and the robot cannot see its goal") {
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
