// SPDX-License-Identifier: Apache-2.0
// `sidestep audit` alongside a run of real processes.
#include <filesystem>
#include <fstream>

#include "tests/catch.hpp"
#include "tests/faults/launched_run.hpp"

using namespace sidestep;

namespace {

/// Audits the run for six seconds with this scenario file. Returns the audit's exit reason.
std::string audit(LaunchedRun& run, const std::string& scenario_file) {
  std::vector<std::string> arguments{"audit", scenario_file, "--seconds", "6"};
  for (const std::string& word : run.dds_arguments()) arguments.push_back(word);
  return run.command(arguments);
}

}  // namespace

TEST_CASE(
    "an audit that joins a running run judges the run unless the audit's scenario has different rules") {
  LaunchedRun run(shuttles(20, ""));
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() > 0.8; }));
  const std::string reason = audit(run, run.scenario_file());
  INFO(run.output());
  CHECK(reason == "exit code 0");
  CHECK(run.printed("audit: passed (coverage "));
  CHECK(run.printed("positions and contacts from: ground truth"));

  const auto other = std::filesystem::path(run.scenario_file()).replace_filename("other.yaml");
  std::ofstream(other) << shuttles(20, "margin_m: 0.02\n");
  CHECK(audit(run, other.string()) == "exit code 3");
  CHECK(run.printed("messages come from processes with different rules"));
}
