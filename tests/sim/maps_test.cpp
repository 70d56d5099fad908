// SPDX-License-Identifier: Apache-2.0
// Floors whose obstacles are the blocked cells of a map, in whole systems.
#include <filesystem>
#include <unistd.h>

#include "common/config/planner_names.hpp"
#include "common/config/scenario_loader.hpp"
#include "common/map/floor_plan.hpp"
#include "deploy/trial/simulate/building/building.hpp"
#include "deploy/trial/simulate/campaign/position_sampler.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/map/random_map.hpp"

namespace sidestep::maps_test {

void require_safe(const SimSystem& system) {
  const Report report = system.metrics().report();
  CHECK(report.contacts == 0);
  REQUIRE(report.audit);
  CHECK(report.audit->verdict() == AuditVerdict::kPassed);
}

/// Robots at random places of a random floor plan of 12 x 9 m, with single blocked cells as in maps made with
/// a laser.
Scenario random_building(std::uint64_t seed, int robots) {
  Rng rng(seed);
  Scenario scenario;
  scenario.name = "building";
  scenario.field = {12, 9};
  MapGrid grid;
  grid.columns = 240, grid.rows = 180, grid.origin_m = {-6, -4.5};
  FloorPlanSettings rooms;
  rooms.min_room_m = 2.5;
  rooms.max_room_m = 5;
  rooms.corridor_m = 1.2;
  rooms.aisle_m = 0.8;
  rooms.shelf_m = 0.4;
  rooms.door_m = 0.8;
  BitGrid blocked = make_floor_plan(rng.bits(), grid, rooms).blocked();
  for (int i = 0; i < 20; ++i) {
    const auto column = static_cast<int>(rng.below(240)), row = static_cast<int>(rng.below(180));
    blocked.set(column, row);
  }
  scenario.map = std::make_shared<const FloorMap>(OccupancyMap(grid, std::move(blocked)));
  PositionSampler sampler(scenario, rng);
  std::vector<Vec2> starts, goals;
  for (int i = 0; i < robots; ++i) {
    starts.push_back(sampler.sample_apart(starts));
    goals.push_back(sampler.sample_apart(goals));
    scenario.robots.push_back(
        {.id = static_cast<RobotId>(i), .start_m = starts.back(), .goals = {{goals.back()}}});
  }
  return scenario;
}

TEST_CASE("robots drive through buildings that a map describes, without contact") {
  const std::uint64_t seed = GENERATE(range<std::uint64_t>(1, 9));
  CAPTURE(seed);
  SimSystem system(random_building(seed, 6), seed);
  CHECK(system.run_until_arrived(system.begin() + std::chrono::seconds(90)));
  require_safe(system);
}

/// Two rooms joined by a corridor 0.25 to 0.35 m wide, in which robots of 0.18 m cannot pass each other
/// except in its one to three bays.
Scenario random_corridor(std::uint64_t seed) {
  Rng rng(seed);
  Scenario scenario;
  scenario.name = "corridor";
  scenario.field = {9, 4};
  MapGrid grid;
  grid.columns = 180, grid.rows = 80, grid.origin_m = {-4.5, -2};
  BitGrid blocked(grid.columns, grid.rows);
  for (int row = 0; row < grid.rows; ++row) blocked.set_run(0, grid.columns, row);
  const auto clear = [&](int begin, int end, int first_row, int end_row) {
    for (int row = first_row; row < end_row; ++row) blocked.set_run(begin, end, row, false);
  };
  const auto below = [&](std::uint64_t n) { return static_cast<int>(rng.below(n)); };
  const int width = 5 + below(3), row = 30 + below(14);
  clear(3, 40, 16, 64);
  clear(140, 177, 16, 64);
  clear(40, 140, row, row + width);
  for (int bays = 1 + below(3); bays > 0; --bays) {
    const int begin = 45 + below(80), depth = 7 + below(3);
    rng.chance(0.5) ? clear(begin, begin + 8, row + width, row + width + depth)
                    : clear(begin, begin + 8, row - depth, row);
  }
  scenario.map = std::make_shared<const FloorMap>(OccupancyMap(grid, std::move(blocked)));
  for (int i = 0; i < 4; ++i) {
    const double side = i % 2 == 0 ? -1 : 1, y = i < 2 ? 0.7 : -0.7;
    scenario.robots.push_back({.id = static_cast<RobotId>(i),
                               .start_m = {3 * side, y},
                               .goals = {{{-3.2 * side, y}}, {{3.8 * side, y}}}});
  }
  return scenario;
}

TEST_CASE("robots that meet in a corridor too narrow for two let each other pass") {
  const std::uint64_t seed = GENERATE(range<std::uint64_t>(1, 13));
  CAPTURE(seed);
  SimSystem system(random_corridor(seed), seed);
  CHECK(system.run_until_arrived(system.begin() + std::chrono::seconds(240)));
  require_safe(system);
}

/// A building of 2,000 by 2,000 cells, written to files as a user would.
Scenario large_building(const std::string& kind, std::uint64_t seed) {
  const auto folder = std::filesystem::temp_directory_path() / ("sidestep-maps-" + std::to_string(getpid()));
  BuildingOptions options;
  options.folder = folder.string();
  options.kind = kind;
  options.seed = seed;
  options.robots = 4;
  options.goals = 1;
  write_building(options);
  Scenario scenario = load_scenario((folder / "scenario.yaml").string());
  std::filesystem::remove_all(folder);
  return scenario;
}

TEST_CASE("robots find their way through buildings of 100 x 100 m, without contact", "[slow]") {
  const auto kind = GENERATE(from_range(kBuildingKinds));
  const auto planner = GENERATE(as<std::string>(), "lazy-visibility", "estar");
  const std::uint64_t seed = GENERATE(11u, 12u);
  CAPTURE(kind, planner, seed);
  Scenario scenario = large_building(kind, seed);
  use_planner(scenario, planner);
  SimSystem system(scenario, seed);
  CHECK(system.run_until_arrived(system.begin() + from_seconds(scenario.time_limit_s)));
  require_safe(system);
}

TEST_CASE("robots in the shipped buildings arrive among people, and no moving robot touches a person") {
  const auto name = GENERATE(as<std::string>(), "corridor", "house");
  CAPTURE(name);
  SimSystem system(load_scenario(SIDESTEP_SOURCE_DIR "/deploy/scenarios/" + name + ".yaml"), 3);
  CHECK(system.run_until_arrived(system.begin() + std::chrono::seconds(600)));
  require_safe(system);
  CHECK(system.metrics().report().crashes_while_moving == 0);
}

}  // namespace sidestep::maps_test
