// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/conformance/conformance_row.hpp"

#include "tests/catch.hpp"

namespace sidestep::conformance_row_test {

using namespace std::chrono_literals;

ConformanceReport report_with(Conformity conformity) {
  ConformanceReport report;
  report.rows = {{"reports", Conformity::kPassed, ""}, {"turning", conformity, ""}};
  report.figures.tracking_bound_m = 0.014;
  report.figures.clock_bound_s = 0.0005;
  report.figures.is_within_limits = true;
  return report;
}

TEST_CASE("figures for the scenario are printed only if every row passed, and other rows are named") {
  CHECK_THAT(scenario_lines(report_with(Conformity::kPassed)),
             ContainsSubstring("tracking_bound_m: 0.014\nmargin_m: 0.032\n"));
  const Conformity conformity = GENERATE(Conformity::kFailed, Conformity::kNotJudged);
  CHECK(scenario_lines(report_with(conformity)) ==
        "no figures for the scenario, because not every row passed: turning\n");
}

TEST_CASE("the figures say how far a robot moves when commands end, if that was measured") {
  ConformanceReport report = report_with(Conformity::kPassed);
  CHECK(scenario_lines(report).find("killed") == std::string::npos);
  report.figures.silence_m = 0.151;
  CHECK_THAT(scenario_lines(report), ContainsSubstring("may stop up to 0.16 m beyond its version"));
}

TEST_CASE("the latency has its interval, and what a millisecond costs") {
  const ConformanceRow row = latency_row({100ms, 18ms, 1500us, 2}, 0.04);
  CHECK(row.conformity == Conformity::kPassed);
  CHECK_THAT(row.figures, ContainsSubstring("after 118 ms, probably between 116.5 and 119.5 ms"));
  CHECK_THAT(row.figures, ContainsSubstring("each millisecond of difference takes it up to 2.0 mm off"));
}

TEST_CASE("an uncertain latency is not judged, unless it is certainly wrong") {
  CHECK(latency_row({100ms, 18ms, 6ms, 2}, 0.04).conformity == Conformity::kNotJudged);
  CHECK(latency_row({100ms, 18ms, 6ms, 2}, 0.03).conformity == Conformity::kNotJudged);
  CHECK(latency_row({100ms, 18ms, 6ms, 2}, 0.02).conformity == Conformity::kFailed);
  CHECK(latency_row({100ms, -18ms, 6ms, 2}, 0.02).conformity == Conformity::kFailed);
  CHECK(latency_row({100ms, 18ms, 1ms, 2}, 0.03).conformity == Conformity::kFailed);
}

TEST_CASE("motors that obey at once pass, but not motors that obey before their commands") {
  const ConformanceRow at_once = latency_row({0ms, -300us, 50us, 2}, 0.01);
  CHECK(at_once.conformity == Conformity::kPassed);
  CHECK_THAT(at_once.figures, ContainsSubstring("after 0 ms, probably between 0.0 and 0.0 ms"));
  const ConformanceRow early = latency_row({0ms, -3ms, 50us, 2}, 0.01);
  CHECK(early.conformity == Conformity::kNotJudged);
  CHECK_THAT(early.figures, ContainsSubstring("before it is commanded"));
}

}  // namespace sidestep::conformance_row_test
