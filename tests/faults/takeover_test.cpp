// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <csignal>

#include "tests/catch.hpp"
#include "tests/faults/keyed_run.hpp"
#include "tests/faults/launched_run.hpp"
#include "tests/faults/takeover_watch.hpp"

using namespace sidestep;

namespace {

constexpr int kKills = 20;

void kill_active_coordinators(const std::string& scenario, const std::vector<std::string>& arguments) {
  LaunchedRun run(scenario, arguments);
  TakeoverWatch watch(run.bus(), 8);
  std::vector<double> first_ms, half_ms;
  for (int i = 0; i < kKills; ++i) {
    INFO("kill " << i << "\n" << run.output());
    REQUIRE(run.wait_until([&] { return watch.is_ready() && run.max_speed_mps() > 1; }));
    const std::string active =
        watch.active() == 0 ? "coordinator" : "coordinator " + std::to_string(watch.active());
    const pid_t pid = run.pid_of(active);
    REQUIRE(pid > 0);
    watch.on_kill();
    const Time killed_at = run.bus().now();
    REQUIRE(kill(pid, SIGKILL) == 0);
    REQUIRE(run.wait_until([&] { return watch.moving(4).has_value(); }));
    first_ms.push_back(to_seconds(*watch.moving(1) - killed_at) * 1e3);
    half_ms.push_back(to_seconds(*watch.moving(4) - killed_at) * 1e3);
  }
  REQUIRE(kill(run.pid(), SIGINT) == 0);
  const std::string ended = run.wait_for_end();
  INFO(run.output());
  CHECK(ended == "exit code 1");
  require_no_violations(run.report());
  CHECK(run.report()["deaths"].size() == kKills);
  const auto [min, max] = std::minmax_element(first_ms.begin(), first_ms.end());
  WARN(
      "from kill -9 of the active coordinator until the first robot executes a version of the standby: "
      "median "
      << median(first_ms) << " ms of " << kKills << " (" << *min << " to " << *max
      << "), until half of the robots do: median " << median(half_ms) << " ms");
}

std::string shuttles_with_standby() { return shuttles(100, "coordinators: 2\nrestart: [coordinator]\n"); }

}  // namespace

TEST_CASE("the standby takes over twenty times while robots move, without contact", "[slow]") {
  kill_active_coordinators(shuttles_with_standby(), {});
}

TEST_CASE("the standby takes over twenty times with keys", "[slow]") {
  const auto keys = keys_for(shuttles_with_standby());
  kill_active_coordinators(shuttles_with_standby(), {"--keys", keys->folder()});
}
