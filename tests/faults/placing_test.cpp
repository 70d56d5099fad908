// SPDX-License-Identifier: Apache-2.0
// Robots of a simulator of the league that start at other places than the scenario's, and more of them.
#include "tests/catch.hpp"
#include "tests/faults/external_simulator_run.hpp"

namespace sidestep::placing_test {
namespace {

const std::vector<std::string> kElevenInALine{"--team-size", "11", "--starts", "line"};

}  // namespace

TEST_CASE("a run that places robots first takes eleven from a start line to the scenario's places",
          "[both-cores][slow]") {
  ExternalSimulatorRun floor(shipped_scenario("league/eleven-blue"), kElevenInALine, {"--place"});
  const std::string ended = floor.run().wait_for_end();
  INFO(floor.run().output());
  CHECK(ended == "exit code 0");
  CHECK(floor.run().printed("placed 11 robot(s) and removed 11 by"));
  const auto report = floor.run().report();
  require_no_violations(report);
  CHECK(report["arrived"] == 11);
  CHECK(floor.run().truth().contacts() == 0);
}

TEST_CASE("a run without vision packets does not start, and names what it waits for") {
  LaunchedRun run(shipped_scenario("league/eleven-blue"),
                  {"--driver", "league", "--place=127.0.0.1:9", "--vision=--ssl-vision 239.255.62.9:10990"});
  const std::string ended = run.wait_for_end();
  INFO(run.output());
  CHECK(ended == "exit code 1");
  CHECK(run.printed("no detections from vision"));
  CHECK(run.children().empty());
}

}  // namespace sidestep::placing_test
