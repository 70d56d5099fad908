// SPDX-License-Identifier: Apache-2.0
#include "tests/study/planning/planning_study.hpp"

#include "tests/catch.hpp"
#include "tests/unit/study/study_files.hpp"

namespace sidestep::planning_study_test {

TEST_CASE("the quick study of planning writes all its tables and pictures") {
  StudyFolder folder;
  StudyOptions options;
  options.folder = folder.path();
  options.seed = 7;
  options.is_quick = true;
  REQUIRE(study_planning(options) == 0);
  for (const char* name :
       {"cache", "strategies", "bridges", "visibility", "roadmaps", "collision", "domains", "terrain"}) {
    CAPTURE(name);
    CHECK(folder.table("planning", name, 7).size() >= 4);
    CHECK(folder.has_png(name));
  }
}

}  // namespace sidestep::planning_study_test
