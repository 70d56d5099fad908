// SPDX-License-Identifier: Apache-2.0
#include "tests/study/clutter/clutter_study.hpp"

#include "tests/catch.hpp"
#include "tests/study/clutter/clutter_scene.hpp"
#include "tests/study/clutter/clutter_summary.hpp"
#include "tests/unit/study/study_files.hpp"

namespace sidestep::clutter_study_test {

TEST_CASE("in the quick clutter study every robot drives among people without a crash in motion") {
  StudyFolder folder;
  StudyOptions options;
  options.folder = folder.path();
  options.seed = 3;
  options.is_quick = true;
  REQUIRE(study_clutter(options) == 0);
  for (const char* name : {"people", "buildings"}) {
    CAPTURE(name);
    const auto rows = folder.table("clutter", name, 3);
    CHECK(rows.size() == 2);
    for (const StudyRow& row : rows) {
      CAPTURE(row.at("planner"));
      CHECK(row.at("contacts") == "0");
      CHECK(row.at("crashes_in_motion") == "0");
      CHECK(row.at("audit") == "passed");
      CHECK(row.at("arrived") == row.at("robots"));
    }
    CHECK(folder.has_png(name));
  }
}

TEST_CASE("the summary of the clutter study counts the runs of each planner and number of people") {
  StudyTable runs;
  runs.name = "people";
  runs.columns = {"planner",           "robots",  "people",   "seed",
                  "seconds",           "arrived", "contacts", "crashes",
                  "crashes_in_motion", "audit"};
  runs.rows = {
      cells("errt", 2, 5, 1, 10.0, 2, 0, 3, 0, "passed"), cells("errt", 2, 5, 2, 30.0, 1, 1, 4, 2, "passed"),
      cells("errt", 2, 5, 3, 20.0, 2, 0, 0, 0, "passed"), cells("errt", 2, 9, 1, 50.0, 0, 0, 0, 0, "passed"),
      cells("nf1", 2, 5, 1, 7.0, 2, 0, 0, 0, "passed")};
  const StudyTable summary = clutter_summary(runs);
  const auto rows = rows_of(summary);
  REQUIRE(rows.size() == 3);
  const StudyRow first{{"planner", "errt"},       {"people", "5"},   {"runs", "3"},
                       {"arrived", "5"},          {"robots", "6"},   {"median_s", "20.0"},
                       {"longest_s", "30.0"},     {"contacts", "1"}, {"crashes", "7"},
                       {"crashes_in_motion", "2"}};
  CHECK(rows[0] == first);
  CHECK(rows[1].at("people") == "9");
  CHECK(rows[2].at("planner") == "nf1");
  const Plot plot = success_plot(summary);
  REQUIRE(plot.lines.size() == 2);
  REQUIRE(plot.lines[0].points.size() == 2);
  CHECK(plot.lines[0].points[0].median == Approx(5.0 / 6));
  CHECK(plot.lines[0].points[1].median == 0);
  CHECK(plot.lines[1].points[0].median == 1);
}

TEST_CASE("a scene of the clutter study depends on the seed and not on the planner") {
  ClutterSettings settings;
  settings.is_building = GENERATE(false, true);
  settings.robots = 4;
  const Scenario first = clutter_scene(settings, 5);
  settings.planner = "errt";
  const Scenario second = clutter_scene(settings, 5), other = clutter_scene(settings, 6);
  CHECK(second.planner == "errt");
  REQUIRE(first.robots.size() == 4);
  CHECK(first.opponents.size() == 5);
  for (std::size_t i = 0; i < first.robots.size(); ++i) {
    CHECK(first.robots[i].start_m == second.robots[i].start_m);
    CHECK(first.robots[i].start_m != other.robots[i].start_m);
    CHECK(first.robots[i].goals.size() == 3);
  }
  CHECK((first.map != nullptr) == settings.is_building);
  if (first.map) CHECK(first.map->fingerprint() == second.map->fingerprint());
}

}  // namespace sidestep::clutter_study_test
