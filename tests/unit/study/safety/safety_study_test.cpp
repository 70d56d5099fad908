// SPDX-License-Identifier: Apache-2.0
#include "tests/study/safety/safety_study.hpp"

#include "tests/catch.hpp"
#include "tests/study/safety/traversal.hpp"
#include "tests/unit/study/study_files.hpp"

namespace sidestep::safety_study_test {

TEST_CASE("the quick study shows that the safety search and the margin prevent contacts") {
  StudyFolder folder;
  StudyOptions options;
  options.folder = folder.path();
  options.seed = 7;
  options.is_quick = true;
  REQUIRE(study_safety(options) == 0);

  const auto traversals = folder.table("safety", "traversals", 7);
  CHECK(sum_of(traversals, "penetration_m_s", "mode", "without") > 0.01);
  CHECK(sum_of(traversals, "contacts", "mode", "without") > 0);
  CHECK(sum_of(traversals, "penetration_m_s", "mode", "with") == 0);
  CHECK(sum_of(traversals, "contacts", "mode", "with") == 0);
  CHECK(sum_of(traversals, "traversals", "mode", "with") > 0);

  const auto margins = folder.table("safety", "margins", 7);
  CHECK(sum_of(margins, "penetration_m_s", "margin_mm", "0") >
        sum_of(margins, "penetration_m_s", "margin_mm", "10"));
  for (const StudyRow& row : margins) {
    const bool is_as_assumed = row.at("odometry") == "usual" && row.at("noise_mm") == "0.5";
    if (is_as_assumed && row.at("margin_mm") == "10") CHECK(std::stod(row.at("penetration_m_s")) == 0);
  }

  const auto times = folder.table("safety", "search", 7);
  CHECK(times.size() == 3 * 5);
  for (const StudyRow& row : times) CHECK(std::stod(row.at("search_us_per_robot")) > 0);
  for (const char* plot : {"traversals", "margins", "search"}) {
    CAPTURE(plot);
    CHECK(folder.has_png(plot));
  }
}

TEST_CASE("robots without safety search traverse as fast as their limits allow") {
  TraversalSettings settings;
  settings.robots = 1;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    CAPTURE(seed);
    const Scenario scenario = traversal_scenario(settings, seed);
    const RobotSpec& robot = scenario.robots.front();
    const double path_m = (robot.goals.front().position_m - robot.start_m).norm();
    // Accelerating to full speed v and braking take v/F + v/D seconds, at a mean speed of v/2.
    const double ramps_s = scenario.limits.speed_mps *
                           (1 / scenario.limits.acceleration_mps2 + 1 / scenario.limits.deceleration_mps2);
    const double straight_line_s = ramps_s / 2 + path_m / scenario.limits.speed_mps;
    const auto result = traverse_without_search(scenario, 10 * straight_line_s);
    CHECK(result.traversals >= 8);
    CHECK(result.traversals <= 10);
    CHECK(result.reference_error_m < 0.003);
    CHECK(result.contacts == 0);
  }
}

TEST_CASE("the same seed gives the same floor and a different seed a different floor") {
  const Scenario a = traversal_scenario({}, 5), b = traversal_scenario({}, 5), c = traversal_scenario({}, 6);
  REQUIRE(a.robots.size() == 8);
  std::size_t moved = 0;
  for (std::size_t i = 0; i < a.robots.size(); ++i) {
    CHECK(a.robots[i].start_m == b.robots[i].start_m);
    moved += a.robots[i].start_m != c.robots[i].start_m;
    for (std::size_t j = 0; j < i; ++j) CHECK((a.robots[i].start_m - a.robots[j].start_m).norm() > 0.4);
  }
  CHECK(moved > 0);
}

}  // namespace sidestep::safety_study_test
