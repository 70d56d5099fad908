// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/crowds/crowd_table.hpp"

#include <algorithm>

#include "tests/catch.hpp"

namespace sidestep::crowd_table_test {

CrowdRow row(const std::string& family, const std::string& method, const CrowdResult& result) {
  CrowdRow row{family, method, {}, {}};
  row.score.add(result);
  return row;
}

std::string cell(const StudyTable& table, std::size_t row, const std::string& column) {
  const auto found = std::ranges::find(table.columns, column);
  REQUIRE(found != table.columns.end());
  return table.rows.at(row).at(static_cast<std::size_t>(found - table.columns.begin()));
}

TEST_CASE("the table of crowds relates the ratio of each method to the reference of the same family") {
  const std::vector<CrowdRow> rows{row("doorway", "sidestep", {12, 12, 0, 0, 1.8, 6, 20}),
                                   row("doorway", "reference", {12, 12, 0, 0, 1.5, 5, 0}),
                                   row("corridor", "sidestep", {8, 8, 0, 0, 1.2, 4, 20}),
                                   row("corridor", "reference", {8, 7, 0, 0, {}, {}, 0})};
  const StudyTable table = crowd_table(rows);
  CHECK(cell(table, 0, "over_reference") == "1.20");
  CHECK(cell(table, 1, "over_reference") == "1.00");
  CHECK(cell(table, 2, "over_reference") == "-");
  CHECK(cell(table, 3, "over_reference") == "-");
  CHECK(cell(table, 3, "ratio") == "-");
  CHECK(cell(table, 3, "arrived") == "7");
}

TEST_CASE("the table of crowds shows the mean and the worst ratio, and the median and the worst makespan") {
  CrowdRow three = row("doorway", "sidestep", {12, 12, 0, 0, 1.0, 3, 20});
  three.score.add({12, 12, 0, 0, 1.1, 4, 20});
  three.score.add({12, 12, 0, 0, 1.5, 9, 20});
  const StudyTable table = crowd_table(std::vector{three});
  CHECK(cell(table, 0, "scenes") == "3");
  CHECK(cell(table, 0, "ratio") == "1.20");
  CHECK(cell(table, 0, "worst_ratio") == "1.50");
  CHECK(cell(table, 0, "makespan_s") == "4.00");
  CHECK(cell(table, 0, "worst_makespan_s") == "9.00");
}

TEST_CASE("the plots of crowds have a bar for each method and family that has a value") {
  const StudyTable table = crowd_table(std::vector{row("doorway", "sidestep", {12, 12, 0, 0, 1.8, 6, 20}),
                                                   row("corridor", "sidestep", {8, 7, 0, 0, {}, {}, 20}),
                                                   row("corridor", "reference", {8, 8, 0, 0, 1.1, 4, 0})});
  REQUIRE(table.plots.size() == 5);
  const Plot& ratio = table.plots.front();
  CHECK(ratio.categories == std::vector<std::string>{"doorway", "corridor"});
  REQUIRE(ratio.lines.size() == 2);
  REQUIRE(ratio.lines[0].points.size() == 1);
  CHECK(ratio.lines[0].points[0].x == 0);
  REQUIRE(ratio.lines[1].points.size() == 1);
  CHECK(ratio.lines[1].points[0].x == 1);
  // The reference needs no time, which a logarithmic axis cannot show.
  CHECK(table.plots.back().lines.size() == 1);
}

}  // namespace sidestep::crowd_table_test
