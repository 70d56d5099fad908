// SPDX-License-Identifier: Apache-2.0
// A fleet whose agents run with another version of Fast DDS than its coordinators, vision and simulator.
// tests/mixed provides the other version's programs.
#include <cstdlib>
#include <fmt/format.h>
#include <fstream>
#include <signal.h>

#include "tests/catch.hpp"
#include "tests/faults/keyed_run.hpp"
#include "tests/faults/launched_run.hpp"
#include "tests/faults/takeover_watch.hpp"

using namespace sidestep;

namespace {

/// A hosts file with two namespaces. For an empty folder the programs next to this test run.
std::string hosts_file(const std::string& floor_programs, const std::string& agent_programs) {
  const auto programs = [](const std::string& folder) {
    return folder.empty() ? std::string() : "    programs: " + folder + "\n";
  };
  return "create: true\nlauncher: {interface: 10.77.0.254}\nhosts:\n"
         "  - name: floor\n    transport: {namespace: floor}\n    interface: 10.77.0.1\n"
         "    processes: [simulator, vision, coordinator]\n    standbys: rest\n" +
         programs(floor_programs) +
         "  - name: robots\n    transport: {namespace: robots}\n    interface: 10.77.0.2\n    agents: "
         "rest\n" +
         programs(agent_programs);
}

std::string with_two_coordinators(std::string scenario) {
  const std::string key = "robots:";
  scenario.insert(scenario.find(key), "coordinators: 2\nrestart: [coordinator]\n");
  return scenario;
}

/// Kills the active coordinator while robots drive through 5 % packet loss; returns the time in milliseconds
/// until a robot executes a version that the standby granted.
double drive_and_kill_coordinator(const std::string& hosts) {
  const auto run =
      LaunchedRun::on_namespaces(with_two_coordinators(shipped_scenario("two-teams-22")), {}, hosts);
  for (const char* host : {"floor", "robots"}) {
    const std::string name = "sidestep-" + std::to_string(run->pid()) + "-" + host;
    REQUIRE(run->command({"fault", "link", name, "--loss", "0.05"}) == "exit code 0");
  }
  TakeoverWatch watch(run->bus(), 22);
  const bool drives = run->wait_until([&] { return watch.is_ready() && run->max_speed_mps() > 1; });
  INFO(run->output());
  REQUIRE(drives);
  const std::string active =
      watch.active() == 0 ? "coordinator" : "coordinator " + std::to_string(watch.active());
  watch.on_kill();
  const Time killed_at = run->bus().now();
  REQUIRE(kill(run->pid_of(active), SIGKILL) == 0);
  const bool has_taken_over = run->wait_until([&] { return watch.moving(1).has_value(); });
  const std::string ended = run->wait_for_end();
  CHECK(ended == "exit code 0");
  REQUIRE(has_taken_over);
  require_no_violations(run->report());
  CHECK(run->report()["arrived"] == 22);
  CHECK(run->logged("Fast DDS 2."));
  CHECK(run->logged("Fast DDS 3."));
  return to_seconds(*watch.moving(1) - killed_at) * 1e3;
}

}  // namespace

TEST_CASE("a fleet with two versions of Fast DDS arrives despite packet loss and the coordinator's death",
          "[.mixed][slow]") {
  const char* other = std::getenv("SIDESTEP_OTHER_PROGRAMS");
  REQUIRE(other);
  constexpr int kRuns = 5;
  constexpr double kMaxMedian_ms = 300;
  const auto file =
      std::filesystem::temp_directory_path() / ("sidestep-mixed-" + std::to_string(getpid()) + ".yaml");
  std::vector<double> takeovers_ms;
  for (const bool agents_are_other : {true, false}) {
    std::ofstream(file) << hosts_file(agents_are_other ? "" : other, agents_are_other ? other : "");
    for (int i = 0; i < kRuns; ++i) {
      CAPTURE(agents_are_other, i);
      takeovers_ms.push_back(drive_and_kill_coordinator(file.string()));
      fmt::print("{} in the other tree, run {}: 22 robots arrived, takeover {:.0f} ms\n",
                 agents_are_other ? "agents" : "all but the agents", i, takeovers_ms.back());
    }
  }
  std::filesystem::remove(file);
  fmt::print("takeover: median {:.0f} ms of {}\n", median(takeovers_ms), takeovers_ms.size());
  CHECK(median(takeovers_ms) <= kMaxMedian_ms);
}

TEST_CASE("a fleet with keys and two versions of Fast DDS does not start, and logs the reason",
          "[.mixed][slow]") {
  const char* other = std::getenv("SIDESTEP_OTHER_PROGRAMS");
  REQUIRE(other);
  const auto file =
      std::filesystem::temp_directory_path() / ("sidestep-mixed-" + std::to_string(getpid()) + ".yaml");
  std::ofstream(file) << hosts_file("", other);
  const std::string scenario = shipped_scenario("crossing");
  const auto keys = keys_for(scenario);
  const auto run = LaunchedRun::on_namespaces(scenario, {"--keys", keys->folder()}, file.string());
  const std::string why =
      "that uses another version of Fast DDS: processes with keys understand only their own version";
  CHECK(run->wait_until([&] { return run->logged("keys: refuses agent 0 at 10.77.0.2 " + why); }));
  CHECK(run->wait_until([&] { return run->logged("keys: refuses coordinator 0 at 10.77.0.1 " + why); }));
  CHECK(run->wait_for_end() == "exit code 1");
  std::filesystem::remove(file);
}
