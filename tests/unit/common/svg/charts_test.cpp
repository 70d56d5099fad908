// SPDX-License-Identifier: Apache-2.0
#include "common/svg/charts.hpp"

#include <regex>

#include "tests/catch.hpp"

namespace sidestep::charts_test {

/// The widths of the bars.
std::vector<double> widths(const std::string& svg) {
  std::vector<double> result;
  const std::regex pattern("<rect [^>]*width='([0-9.]+)'");
  for (std::sregex_iterator match(svg.begin(), svg.end(), pattern), end; match != end; ++match)
    result.push_back(std::stod((*match)[1]));
  return result;
}

TEST_CASE("bars are as long as their values, and say them") {
  const std::string svg =
      bar_chart({{"robot 1", 2, "2.00 s", "#111111"}, {"robot <2>", 4, "4.00 s", "#222222"}}, {"time [s]"});
  CAPTURE(svg);
  const std::vector<double> bars = widths(svg);
  REQUIRE(bars.size() == 2);
  CHECK(bars[0] > 100);
  CHECK(bars[1] == Approx(2 * bars[0]).margin(0.2));
  CHECK_THAT(svg, ContainsSubstring("robot &lt;2&gt;") && ContainsSubstring(">4.00 s</text>") &&
                      ContainsSubstring(">time [s]</text>"));
  // There is no line from one category to the next.
  CHECK_THAT(svg, !ContainsSubstring("<polyline"));
}

TEST_CASE("on a logarithmic axis each power of ten has the same length") {
  const std::vector<double> bars = widths(bar_chart({{"a", 10, "", "#111111"},
                                                     {"b", 100, "", "#111111"},
                                                     {"c", 1000, "", "#111111"},
                                                     {"none", 0, "", "#111111"},
                                                     {"d", 1, "", "#111111"}},
                                                    {"time", true}));
  REQUIRE(bars.size() == 5);
  CHECK(bars[0] > 100);
  CHECK(bars[1] == Approx(2 * bars[0]).margin(0.2));
  CHECK(bars[2] == Approx(3 * bars[0]).margin(0.3));
  CHECK(bars[3] == 0);
}

TEST_CASE("charts of nothing, and of values that are all zero, have no invalid numbers") {
  for (const bool is_logarithmic : {false, true}) {
    for (const std::vector<ChartBar>& bars :
         {std::vector<ChartBar>{}, std::vector<ChartBar>{{"a", 0, "0", "#111111"}}}) {
      const std::string svg = bar_chart(bars, {"time", is_logarithmic});
      CHECK_THAT(svg, !ContainsSubstring("nan") && !ContainsSubstring("inf"));
    }
  }
  CHECK(line_chart({}, {"x", "y"}).empty());
  CHECK(line_chart({{"a", "#111111", {{1, 2}}}}, {"x", "y"}).empty());
}

TEST_CASE("charts of values that no run has are small and have no invalid numbers") {
  for (const double value : {5e-324, 1e-300, 1e300, 1.7e308}) {
    CAPTURE(value);
    for (const bool is_logarithmic : {false, true}) {
      const std::string long_text(400, '7');
      const std::string svg =
          bar_chart({{"a", value, long_text, "#111111"}, {"b", 1, "1", "#111111"}}, {"time", is_logarithmic});
      CHECK(svg.size() < 50'000);
      CHECK_THAT(svg,
                 !ContainsSubstring("nan") && !ContainsSubstring("inf") && !ContainsSubstring("width='-"));
      CHECK(bar_chart({{"a", value, "", "#111111"}}, {"time", is_logarithmic}).size() < 50'000);
    }
    CHECK(line_chart({{"a", "#111111", {{0, value}, {value, 0}}}}, {"x", "y"}).size() < 50'000);
  }
}

TEST_CASE("a line chart has a line for each series, marks on both axes, and the limit") {
  LineAxes axes{"time [s]", "speed [m/s]"};
  axes.marked_y = 2;
  axes.mark_label = "limit";
  const std::string svg = line_chart(
      {{"robot 1", "#123456", {{0, 0}, {10, 1.5}}}, {"robot 2", "#654321", {{0, 1}, {5, 0}}}}, axes);
  CAPTURE(svg);
  CHECK_THAT(svg, ContainsSubstring("stroke='#123456'") && ContainsSubstring("stroke='#654321'") &&
                      ContainsSubstring("<title>robot 2</title>") && ContainsSubstring(">limit</text>") &&
                      ContainsSubstring(">10</text>") && ContainsSubstring(">2.0</text>"));
}

}  // namespace sidestep::charts_test
