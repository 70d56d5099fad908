// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/page/report_events.hpp"

#include <fmt/format.h>

#include "tests/catch.hpp"
#include "tests/unit/deploy/audit/page/report_example.hpp"

namespace sidestep::report_events_test {

std::vector<std::string> lines_of(const Report& report) {
  std::vector<std::string> lines;
  for (const ReportEvent& event : events_of(json_of(report)))
    lines.push_back(fmt::format("{} {}{}", event.at_s ? fmt::format("{:.2f}", *event.at_s) : "?",
                                event.is_bad ? "! " : "", event.text));
  return lines;
}

TEST_CASE("the events of a report are everything that happened, in the order of time") {
  const std::vector<std::string> lines = lines_of(example_report());
  REQUIRE(lines.size() == 8);
  CHECK(lines[0] == "-0.50 coordinator began epoch 1000000000000: started");
  CHECK(lines[1] == "0.00 a coordinator grants: robots may move");
  CHECK(lines[2] == "0.50 ! contact: robots 3 and 8");
  CHECK(lines[3] == "1.25 robot 3 arrived");
  CHECK(lines[4] == "2.50 agent 8 died: killed by signal 9; it was started again");
  CHECK_THAT(lines[5], StartsWith("3.00 ! the rule ") &&
                           EndsWith(" was broken: robot 8 version 17: <moved> too early"));
  CHECK(lines[6] == "6.00 ! robot 8 has not arrived: no path leads to its goal");
  CHECK_THAT(lines[7], StartsWith("6.00 ! end: failed: 1 contacts"));
}

TEST_CASE("events without a time come last") {
  Report report = example_report();
  report.quarantined = {3};
  report.conflicts = {{3, 8}};
  report.mismatches = {{"vision", {{"margin_m", "0.01", "0.02"}}}};
  report.director_deaths = {"killed by signal 9"};
  const std::vector<std::string> lines = lines_of(report);
  REQUIRE(lines.size() == 12);
  CHECK(lines[8] == "? ! the process that directed the run died: killed by signal 9");
  CHECK(lines[9] == "? ! robot 3 was quarantined: it executed a version that it was never granted");
  CHECK(lines[10] == "? ! a cause outside the protocol brought robots 3 and 8 into conflict");
  CHECK(lines[11] == "? ! vision was refused because it has different rules: margin_m");
}

TEST_CASE("a run that passed has no bad events") {
  Report report = example_report();
  report.contacts = 0;
  report.arrived = 2;
  report.not_arrived.clear();
  report.audit.reset();
  report.trace.reset();
  for (const std::string& line : lines_of(report)) CHECK_THAT(line, !ContainsSubstring("!"));
}

}  // namespace sidestep::report_events_test
