// SPDX-License-Identifier: Apache-2.0
#include "deploy/evaluation/study/clutter/clutter_study.hpp"

#include "deploy/evaluation/study/clutter/clutter_scene.hpp"
#include "tests/catch.hpp"
#include "tests/unit/deploy/evaluation/study/study_files.hpp"

namespace sidestep::clutter_study_test {

TEST_CASE("the quick study drives every robot among people without a crash in motion") {
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

TEST_CASE("a scene of the clutter study depends on the seed, and not on the planner") {
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
