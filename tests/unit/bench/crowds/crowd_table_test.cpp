// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/crowds/crowd_table.hpp"

#include <algorithm>
#include <vector>

#include "tests/catch.hpp"

namespace sidestep::crowd_table_test {

/// A row with the results of the seeds 1, 2, ...
CrowdRow row(const std::string& family, const std::string& method, const std::vector<CrowdResult>& results) {
  CrowdRow row{family, method, {}, {}};
  for (std::uint64_t seed = 1; seed <= results.size(); ++seed) row.score.add(seed, results[seed - 1]);
  return row;
}

std::string cell(const StudyTable& table, std::size_t row, const std::string& column) {
  const auto found = std::ranges::find(table.columns, column);
  REQUIRE(found != table.columns.end());
  return table.rows.at(row).at(static_cast<std::size_t>(found - table.columns.begin()));
}

TEST_CASE("the table of crowds relates the ratio of each method to the reference of the same family") {
  const std::vector<CrowdRow> rows{row("doorway", "sidestep", {{12, 12, 0, 0, 1.8, 6, 20}}),
                                   row("doorway", "reference", {{12, 12, 0, 0, 1.5, 5, 0}}),
                                   row("corridor", "sidestep", {{8, 8, 0, 0, 1.2, 4, 20}}),
                                   row("corridor", "reference", {{8, 7, 0, 0, {}, {}, 0}})};
  const StudyTable table = crowd_table(rows);
  CHECK(cell(table, 0, "over_reference") == "1.20");
  CHECK(cell(table, 1, "over_reference") == "1.00");
  CHECK(cell(table, 2, "over_reference") == "-");
  CHECK(cell(table, 3, "over_reference") == "-");
  CHECK(cell(table, 3, "ratio") == "-");
  CHECK(cell(table, 3, "arrived") == "7");
}

TEST_CASE("the table of crowds shows the mean and the worst ratio, and the median and the worst makespan") {
  const CrowdRow three =
      row("doorway", "sidestep",
          {{12, 12, 0, 0, 1.0, 3, 20}, {12, 12, 0, 0, 1.1, 4, 20}, {12, 12, 0, 0, 1.5, 9, 20}});
  const StudyTable table = crowd_table(std::vector{three});
  CHECK(cell(table, 0, "scenes") == "3");
  CHECK(cell(table, 0, "ratio") == "1.20");
  CHECK(cell(table, 0, "worst_ratio") == "1.50");
  CHECK(cell(table, 0, "makespan_s") == "4.00");
  CHECK(cell(table, 0, "worst_makespan_s") == "9.00");
}

constexpr CrowdResult kStuck{12, 11, 0, 0, {}, {}, 20};

TEST_CASE("the table of crowds compares methods over the scenes that both completed") {
  // The baseline is slower in every scene, but fails the hard ones.
  const std::vector<CrowdRow> rows{
      row("doorway", "sidestep",
          {{12, 12, 0, 0, 1.0, 3, 20}, {12, 12, 0, 0, 4.0, 9, 20}, {12, 12, 0, 0, 1.2, 4, 20}, kStuck}),
      row("doorway", "reciprocal", {{12, 12, 0, 0, 1.5, 4, 1}, kStuck, {12, 12, 0, 0, 1.8, 5, 1}, kStuck}),
      row("doorway", "reference", {kStuck, kStuck, {12, 12, 0, 0, 1.2, 4, 0}, {12, 12, 0, 0, 1.3, 4, 0}})};
  const StudyTable table = crowd_table(rows);
  CHECK(cell(table, 0, "complete") == "3");
  CHECK(cell(table, 1, "complete") == "2");
  CHECK(cell(table, 0, "ratio") == "2.07");
  CHECK(cell(table, 1, "ratio") == "1.65");
  CHECK(cell(table, 0, "over_sidestep") == "1.00");
  CHECK(cell(table, 1, "over_sidestep") == "1.50");
  CHECK(cell(table, 2, "over_sidestep") == "1.00");
  CHECK(cell(table, 1, "over_reference") == "1.50");
  // Only the third scene has been completed by all.
  REQUIRE(table.plots.front().lines.size() == 3);
  CHECK(table.plots.front().lines[0].points.at(0).median == Approx(1.2));
  CHECK(table.plots.front().lines[1].points.at(0).median == Approx(1.8));
}

TEST_CASE("in medians and worst values of crowds, scenes that are not complete are later than all others") {
  const StudyTable table = crowd_table(std::vector{
      row("doorway", "sidestep", {{12, 12, 0, 0, 1.0, 3, 20}, kStuck, {12, 12, 0, 0, 1.5, 9, 20}}),
      row("doorway", "reciprocal", {kStuck, {12, 12, 0, 0, 1.2, 4, 1}, kStuck})});
  CHECK(cell(table, 0, "worst_ratio") == "failed");
  CHECK(cell(table, 0, "makespan_s") == "9.00");
  CHECK(cell(table, 0, "worst_makespan_s") == "failed");
  CHECK(cell(table, 1, "makespan_s") == "failed");
  // There is no scene that both completed.
  CHECK(cell(table, 1, "ratio") == "1.20");
  CHECK(cell(table, 1, "over_sidestep") == "-");
}

TEST_CASE("the plots of crowds have a bar for each method and family that has a value") {
  const StudyTable table = crowd_table(std::vector{row("doorway", "sidestep", {{12, 12, 0, 0, 1.8, 6, 20}}),
                                                   row("corridor", "sidestep", {{8, 7, 0, 0, {}, {}, 20}}),
                                                   row("corridor", "reference", {{8, 8, 0, 0, 1.1, 4, 0}})});
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
