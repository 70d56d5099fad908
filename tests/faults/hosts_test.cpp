// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>

#include "tests/faults/launched_run.hpp"
#include "tests/needs_root.hpp"

using namespace sidestep;

namespace {

void require_untouched(const nlohmann::json& report) {
  REQUIRE(report.is_object());
  CHECK(report["contacts"] == 0);
  CHECK(report["firmware_violations"] == 0);
}

bool is_any_namespace_of(pid_t launcher) {
  const auto all = run_namespaces();
  return std::any_of(all.begin(), all.end(), [&](const auto& one) { return one.launcher == launcher; });
}

std::string figures(const nlohmann::json& report) {
  return "makespan " + report["makespan_s"].dump() + " s, missed " + report["missed_cycles"].dump() + " of " +
         report["cycles"].dump() + " cycles, negotiation " + report["negotiation_us"].dump() + " us";
}

}  // namespace

TEST_CASE("22 robots spread over three hosts that lose one packet in twenty all arrive untouched") {
  SIDESTEP_NEEDS_ROOT();
  const auto run = LaunchedRun::on_three_hosts(shipped_scenario("two-teams-22"));
  for (const char* host : {"floor", "east", "west"}) {
    const std::string name = "sidestep-" + std::to_string(run->pid()) + "-" + host;
    REQUIRE(run->command({"fault", "link", name, "--loss", "0.05"}) == "exit code 0");
  }
  CHECK(run->wait_for_end() == "exit code 0");
  INFO(run->output());
  const auto report = run->report();
  require_untouched(report);
  CHECK(report["arrived"] == 22);
  for (const char* host : {"floor", "east", "west"}) CHECK(run->robots_on(host).size() >= 7);
  CHECK_FALSE(is_any_namespace_of(run->pid()));
  WARN("22 robots, three hosts, 5 % loss: " << figures(report));
}
