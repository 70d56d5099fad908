// SPDX-License-Identifier: Apache-2.0
#include "tests/study/navigation/navigation_study.hpp"

#include "tests/catch.hpp"
#include "tests/unit/study/study_files.hpp"

namespace sidestep::navigation_study_test {

TEST_CASE("the quick study of navigation functions shows the effects of grids and costs") {
  StudyFolder folder;
  StudyOptions options;
  options.folder = folder.path();
  options.seed = 3;
  options.is_quick = true;
  REQUIRE(study_navigation(options) == 0);
  for (const char* name : {"directions", "obstacles", "replanning", "costs"}) CHECK(folder.has_png(name));
  for (const StudyRow& row : folder.table("navigation", "directions", 3)) {
    const double error = std::stod(row.at("mean_error_cells"));
    CAPTURE(row.at("kernel"), row.at("direction_deg"));
    if (row.at("kernel") == "line of sight") CHECK(std::abs(error) < 1e-3);
    if (row.at("kernel") == "NF1" && row.at("direction_deg") == "45") CHECK(error > 5);
    if (row.at("kernel") == "NF1" && row.at("direction_deg") == "0") CHECK(error < 1);
  }
  for (const StudyRow& row : folder.table("navigation", "obstacles", 3)) {
    CAPTURE(row.at("kernel"), row.at("blocked_percent"));
    CHECK(std::stod(row.at("path_over_exact")) > 0.9999);
  }
  for (const StudyRow& row : folder.table("navigation", "replanning", 3)) {
    CHECK(row.at("equals_fresh") == "true");
    CHECK(std::stod(row.at("changed_cells")) > 10);
  }
  std::vector<double> inside_m, clearances_m;
  for (const StudyRow& row : folder.table("navigation", "costs", 3)) {
    if (row.at("costs") == "region") inside_m.push_back(std::stod(row.at("in_region_m")));
    if (row.at("costs") == "person") clearances_m.push_back(std::stod(row.at("clearance_m")));
  }
  CHECK(inside_m.front() > 2.9);
  CHECK(inside_m.back() < 0.1);
  CHECK(clearances_m.front() < 0);
  CHECK(clearances_m.back() > clearances_m.front() + 0.2);
}

}  // namespace sidestep::navigation_study_test
