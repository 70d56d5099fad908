// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/planning/world_file.hpp"

#include <filesystem>

#include "common/config/scenario_loader.hpp"
#include "tests/catch.hpp"

namespace sidestep::world_file_test {

const std::string kQuery = "queries: [{start_m: [0, 0], goal_m: [1, 0]}]\n";

void check_refused(const std::string& text, int line, const std::string& reason) {
  CAPTURE(text);
  std::string message = "accepted";
  try {
    static_cast<void>(parse_plan_world(text, "file.yaml"));
  } catch (const ConfigError& error) {
    message = error.what();
  }
  CHECK_THAT(message, StartsWith("file.yaml:" + std::to_string(line) + ": "));
  CHECK_THAT(message, ContainsSubstring(reason));
}

TEST_CASE("a world survives writing and reading") {
  const std::string name = GENERATE(from_range(world_names()));
  const PlanWorld world = make_world(name, 5, 3);
  const PlanWorld read = parse_plan_world(plan_world_text(world), "other.yaml");
  CHECK(read.name == name);
  CHECK(read.radius_m == world.radius_m);
  CHECK(read.field.length_m == world.field.length_m);
  CHECK(read.queries.size() == 5);
  CHECK(read.queries[4].goal_m == world.queries[4].goal_m);
  REQUIRE(read.obstacles.size() == world.obstacles.size());
  CHECK(plan_world_text(read) == plan_world_text(world));
}

TEST_CASE("every shipped world loads") {
  int count = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(SIDESTEP_SOURCE_DIR "/deploy/trial/planning/worlds")) {
    CAPTURE(entry.path());
    const PlanWorld world = load_plan_world(entry.path().string());
    CHECK(world.name == entry.path().stem().string());
    ++count;
  }
  CHECK(count > 0);
}

TEST_CASE("errors in a world file are reported with their line") {
  check_refused("radius_m: 0.1\n", 1, "queries");
  check_refused("queries: []\n", 1, "at least one query");
  check_refused(kQuery + "radius: 0.1\n", 2, "radius");
  check_refused("queries:\n  - start_m: [0, 0]\n    goal_m: [20, 0]\n", 3,
                "queries[0].goal_m: expected |x| <= 4.9 and |y| <= 4.9, so that the robot is on the field");
  check_refused("field: {length_m: 2, width_m: 2}\nqueries: [{start_m: [0, -0.95], goal_m: [0, 0]}]\n", 2,
                "queries[0].start_m: expected |x|");
  check_refused(kQuery + "radius_m: -1\n", 2, "radius_m");
  check_refused(kQuery + "obstacles:\n  - ball: {}\n", 3, "ball");
  check_refused(kQuery + "obstacles:\n  - {}\n", 3, "expected one of circle");
  check_refused(kQuery + "obstacles:\n  - circle: {centre_m: [0, 0]}\n", 3, "radius_m");
  check_refused(kQuery + "obstacles:\n  - segment: {from_m: [0, 0], to_m: [0, x]}\n", 3, "to_m");
  check_refused(kQuery + "obstacles:\n\n  - polygon: {corners_m: [[0, 0], [0, 1], [1, 0]]}\n", 4,
                "clockwise");
  check_refused(kQuery + "obstacles:\n  - box: {min_m: [1, 0], max_m: [0, 1]}\n", 3, "min");
}

}  // namespace sidestep::world_file_test
