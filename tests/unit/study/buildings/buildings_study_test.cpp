// SPDX-License-Identifier: Apache-2.0
#include "tests/study/buildings/buildings_study.hpp"

#include "common/config/scenario_loader.hpp"
#include "tests/catch.hpp"
#include "tests/study/buildings/building_run.hpp"
#include "tests/unit/study/study_files.hpp"

namespace sidestep::buildings_study_test {

Scenario two_rooms(bool has_door) {
  const std::string wall = has_door ? "[[0, -2], [0, 0.6]]" : "[[0, -2], [0, 2]]";
  return parse_scenario("field: {length_m: 6, width_m: 4}\nobstacles:\n  - wall: {points_m: " + wall +
                            ", thickness_m: 0.1}\nrobots:\n"
                            "  - {id: 0, start_m: [-2, 0], goals_m: [[2, 1]]}\n"
                            "  - {id: 1, start_m: [2, 0], goals_m: [[-2, 1]]}\n",
                        "rooms.yaml");
}

TEST_CASE("robots reach several random places each, and the same seed gives the same run") {
  const std::uint64_t seed = GENERATE(1u, 2u);
  CAPTURE(seed);
  const BuildingResult first = run_building(two_rooms(true), std::chrono::seconds(60), seed);
  CHECK(first.is_good());
  CHECK(first.trips.reached == first.trips.orders);
  CHECK(first.trips.orders > 10);
  CHECK(first.distance_m > first.trips.orders);
  CHECK(first.trips.longest_s < 20);
  const BuildingResult again = run_building(two_rooms(true), std::chrono::seconds(60), seed);
  CHECK(again.trips.orders == first.trips.orders);
  CHECK(again.distance_m == first.distance_m);
}

TEST_CASE("places that cannot be reached count as blocked") {
  const std::uint64_t seed = GENERATE(1u, 2u);
  CAPTURE(seed);
  const BuildingResult result = run_building(two_rooms(false), std::chrono::seconds(100), seed);
  CHECK(result.is_good());
  CHECK(result.trips.blocked > 0);
  CHECK(result.trips.reached + result.trips.blocked == result.trips.orders);
}

TEST_CASE("the quick study of buildings lists every scenario and planner") {
  StudyFolder folder;
  BuildingsOptions options;
  options.study.folder = folder.path();
  options.study.seed = 3;
  options.study.is_quick = true;
  const std::string file = SIDESTEP_SOURCE_DIR "/deploy/scenarios/house.yaml";
  options.scenario_files = {file};
  options.planners = {"lazy-visibility", "nf1"};
  REQUIRE(study_buildings(options) == 0);
  const auto rows = folder.table(
      "buildings " + file + " --planner lazy-visibility,nf1 --seconds 600 --trials 2", "buildings", 3);
  REQUIRE(rows.size() == 2);
  for (const StudyRow& row : rows) {
    CAPTURE(row.at("planner"));
    CHECK(row.at("scenario") == "house");
    CHECK(row.at("contacts") == "0");
    CHECK(row.at("crashes_in_motion") == "0");
    CHECK(std::stoi(row.at("orders")) >= 6);
  }
  CHECK(folder.has_png("buildings"));
}

}  // namespace sidestep::buildings_study_test
