// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/crowds/crowd_scene_file.hpp"

#include "common/config/scenario_loader.hpp"
#include "tests/bench/crowds/crowd_families.hpp"
#include "tests/catch.hpp"

namespace sidestep::crowd_scene_file_test {

TEST_CASE("the file of a scene loads as the same scene") {
  for (const CrowdFamily& family : crowd_families()) {
    if (family.name == std::string("mixed-speeds")) continue;
    CAPTURE(family.name);
    const Scenario scene = crowd_scene(family, 7);
    const Scenario loaded = parse_scenario(crowd_scene_file(scene).value(), "scene.yaml");
    CHECK(loaded.field.length_m == scene.field.length_m);
    CHECK(loaded.field.width_m == scene.field.width_m);
    CHECK(loaded.time_limit_s == scene.time_limit_s);
    REQUIRE(loaded.obstacles.size() == scene.obstacles.size());
    for (std::size_t i = 0; i < scene.obstacles.size(); ++i)
      for (const Vec2& point_m : {Vec2(-1, 0.5), Vec2(0, 0), Vec2(2, 1)})
        CHECK(signed_distance(point_m, loaded.obstacles[i]) == signed_distance(point_m, scene.obstacles[i]));
    REQUIRE(loaded.robots.size() == scene.robots.size());
    for (std::size_t i = 0; i < scene.robots.size(); ++i) {
      const RobotSpec &robot = loaded.robots[i], &expected = scene.robots[i];
      CHECK(robot.id == expected.id);
      CHECK(robot.team == expected.team);
      CHECK(robot.start_m == expected.start_m);
      CHECK(robot.start_heading_rad == Approx(expected.start_heading_rad));
      REQUIRE(robot.goals.size() == 1);
      CHECK(robot.goals[0].position_m == expected.goals[0].position_m);
    }
  }
}

TEST_CASE("a scene with speed limits of single robots has no file") {
  CHECK_FALSE(crowd_scene_file(crowd_scene(*find_crowd_family("mixed-speeds"), 1)));
}

}  // namespace sidestep::crowd_scene_file_test
