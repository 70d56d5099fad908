// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/scene_sampler.hpp"

#include <map>

#include "common/config/planner_names.hpp"
#include "deploy/trial/simulate/campaign/trial.hpp"
#include "deploy/trial/simulate/campaign/walk_sampler.hpp"
#include "tests/catch.hpp"

namespace sidestep {

TEST_CASE("about half of the random scenes use the default planner, and every driving planner occurs") {
  std::map<std::string, int> scenes, robots;
  for (std::uint64_t seed = 1; seed <= 600; ++seed) {
    Rng rng(seed);
    Scenario scenario;
    scenario.robots.resize(3);
    sample_planners(scenario, rng);
    ++scenes[scenario.planner];
    for (const RobotSpec& robot : scenario.robots)
      if (!robot.planner.empty()) ++robots[robot.planner];
  }
  CHECK(scenes["lazy-visibility"] > 250);
  CHECK(scenes["lazy-visibility"] < 370);
  for (const std::string_view planner : kDrivingPlanners) {
    CAPTURE(planner);
    const bool ignores_path = planner == "dynamic-window" || planner == "potential-field";
    CHECK((scenes[std::string(planner)] > 0) != ignores_path);
    CHECK((robots[std::string(planner)] > 0) != ignores_path);
  }
}

TEST_CASE("robots in random scenes can reach all of their goals") {
  int scenes = 0;
  // Scene 647 has a pocket between an obstacle and the border that no robot can enter.
  for (std::uint64_t seed = 647; scenes < 8; ++seed) {
    CAPTURE(seed);
    const Scenario scenario = sample_trial(seed, std::chrono::seconds(60), {}, true).scenario;
    if (!scenario.map && scenario.obstacles.empty()) continue;
    ++scenes;
    Rng rng(seed);
    WalkSampler walks(scenario, scenario.radius_m + scenario.margin_m, rng);
    for (const RobotSpec& robot : scenario.robots)
      for (std::size_t i = 0; i < robot.goals.size(); i += 10)
        REQUIRE(walks.path(robot.start_m, robot.goals[i].position_m));
  }
}

}  // namespace sidestep
