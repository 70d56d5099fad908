// SPDX-License-Identifier: Apache-2.0
// Floors with walls, boxes and polygons, in whole systems.
#include <fmt/format.h>

#include "common/config/planner_names.hpp"
#include "common/config/scenario_loader.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "tests/catch.hpp"

namespace sidestep::walls_test {

constexpr double kLength_m = 8, kWidth_m = 5;

void require_safe(const SimSystem& system) {
  const Report report = system.metrics().report();
  CHECK(report.contacts == 0);
  REQUIRE(report.audit);
  CHECK(report.audit->verdict() == AuditVerdict::kPassed);
}

/// A floor with two walls across it with a door each, some furniture, and robots that all change rooms.
std::string random_rooms(Rng& rng) {
  std::string text = fmt::format("field: {{length_m: {}, width_m: {}}}\nobstacles:\n", kLength_m, kWidth_m);
  for (const double x : {-1.3, 1.3}) {
    const double door = rng.uniform(-1.5, 1.5), half = rng.uniform(0.3, 0.6), slant = rng.uniform(-0.4, 0.4);
    text += fmt::format("  - wall: {{points_m: [[{}, -2.5], [{}, {}]], thickness_m: 0.1}}\n", x, x + slant,
                        door - half);
    text += fmt::format("  - wall: {{points_m: [[{}, {}], [{}, 2.5]], thickness_m: 0.06}}\n", x + slant,
                        door + half, x);
  }
  text += fmt::format("  - box: {{min_m: [{}, -0.3], max_m: [0.2, 0.2]}}\n", rng.uniform(-0.3, 0));
  text += fmt::format("  - polygon: {{corners_m: [[2.2, {0}], [2.7, {0}], [2.4, {1}]]}}\n",
                      rng.uniform(-0.5, 0), rng.uniform(0.2, 0.5));
  text += "robots:\n";
  for (int i = 0; i < 6; ++i) {
    const double side = i % 2 == 0 ? -1 : 1;
    text += fmt::format("  - {{id: {}, start_m: [{}, {}], goals_m: [[{}, {}]]}}\n", i, 3.5 * side,
                        -2 + 0.8 * i, -3.3 * side, 2 - 0.8 * i);
  }
  return text;
}

TEST_CASE("robots change rooms through doors of random floor plans, without contact") {
  const std::uint64_t seed = GENERATE(range<std::uint64_t>(1, 13));
  CAPTURE(seed);
  Rng rng(seed);
  const std::string text = random_rooms(rng);
  CAPTURE(text);
  SimSystem system(parse_scenario(text, "rooms.yaml"), seed);
  CHECK(system.run_until_arrived(system.begin() + std::chrono::seconds(60)));
  require_safe(system);
}

TEST_CASE("robots localised in camera images drive from room to room among walls and map cells") {
  const std::uint64_t seed = GENERATE(1u, 2u);
  CAPTURE(seed);
  Rng rng(seed);
  const std::string text = "vision: {columns: 2, overlap_m: 0.4, images: {}}\n" + random_rooms(rng);
  CAPTURE(text);
  Scenario scenario = parse_scenario(text, "rooms.yaml");
  // A map whose border lies around the field, with two blocked cells in it.
  BitGrid blocked(82, 52);
  blocked.set(24, 8);
  blocked.set(60, 40);
  scenario.map = std::make_shared<FloorMap>(OccupancyMap(MapGrid{82, 52, 0.1, {-4.1, -2.6}}, blocked));
  SimSystem system(scenario, seed);
  CHECK(system.run_until_arrived(system.begin() + std::chrono::seconds(60)));
  require_safe(system);
}

TEST_CASE("every planner drives robots from room to room") {
  const auto planner = std::string(GENERATE(from_range(kDrivingPlanners.begin(), kDrivingPlanners.end())));
  CAPTURE(planner);
  Rng rng(1);
  const std::string text = "planner: " + planner + "\n" + random_rooms(rng);
  SimSystem system(parse_scenario(text, "rooms.yaml"), 1);
  const bool arrived = system.run_until_arrived(system.begin() + std::chrono::seconds(60));
  // A dynamic window without a path stops in front of walls.
  if (planner != "dynamic-window") CHECK(arrived);
  require_safe(system);
}

}  // namespace sidestep::walls_test
