// SPDX-License-Identifier: Apache-2.0
#include "deploy/progress.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "common/config/scenario_loader.hpp"

namespace sidestep {
namespace {

const Scenario kFive = parse_scenario("circle: {count: 5, spacing_m: 0.5}\n", "five.yaml");

}  // namespace

TEST_CASE("a progress line says that the run is starting, then the time since the first grant") {
  Judge judge(kFive);
  CHECK_THAT(progress_line(judge, time_from_ns(0)), Catch::StartsWith("starting  0 of 5 arrived"));
  msg::CoordinatorState state;
  state.head().incarnation(1);
  state.head().message_number(1);
  state.head().stamp_ns(2'000'000'000);
  state.coordinator_phase(msg::CoordinatorPhase::COORDINATOR_GRANTING);
  judge.on_coordinator(state);
  const std::string line = progress_line(judge, time_from_ns(5'500'000'000));
  CHECK_THAT(line, Catch::StartsWith("  3.5 s  0 of 5 arrived"));
  CHECK(line.find('\x1b') == std::string::npos);
}

TEST_CASE("a progress table has a line for each robot, and says how many do not fit") {
  Judge judge(kFive);
  msg::AgentStatus status;
  status.robot(2);
  status.head().incarnation(1);
  status.head().message_number(1);
  status.agent_phase(msg::AgentPhase::AGENT_DRIVING);
  status.grants(123);
  judge.on_status(status);
  const auto lines = [](const std::string& text) { return std::count(text.begin(), text.end(), '\n'); };
  const std::string whole = progress_table(judge, Time{}, 100);
  CHECK(lines(whole) == 2 + 5);
  CHECK_THAT(whole, Catch::Contains("2  blue    driving") && Catch::Contains("123"));
  CHECK_THAT(whole, Catch::Contains("3  yellow  silent"));
  const std::string cut = progress_table(judge, Time{}, 2);
  CHECK(lines(cut) == 2 + 2 + 1);
  CHECK_THAT(cut, Catch::EndsWith("... and 3 more\n"));
  CHECK(lines(progress_table(judge, Time{}, -3)) == 2 + 1 + 1);
}

}  // namespace sidestep
