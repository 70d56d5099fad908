// SPDX-License-Identifier: Apache-2.0
// What dead processes leave behind in the others.
#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <signal.h>

#include "tests/catch.hpp"
#include "tests/faults/launched_run.hpp"
#include "tests/faults/process_usage.hpp"
#include "tests/sanitized.hpp"

using namespace sidestep;

namespace {

using namespace std::chrono_literals;

/// A process's memory, and its processor time as a percentage of a core.
struct Load {
  double memory_mb = 0;
  double cpu_percent = 0;
};

std::map<std::string, Load> measure(LaunchedRun& run, const std::string& except, Duration duration) {
  std::map<std::string, ProcessUsage> before = usage_of(run);
  before.erase(except);
  const Time begin = run.bus().now();
  REQUIRE(run.wait_until([&] { return run.bus().now() >= begin + duration; }));
  const double seconds = to_seconds(run.bus().now() - begin);
  const std::map<std::string, ProcessUsage> after = usage_of(run);
  std::map<std::string, Load> result;
  for (const auto& [name, usage] : before) {
    const ProcessUsage& now = after.at(name);
    result[name] = {now.memory_mb, 100 * (now.cpu_s - usage.cpu_s) / seconds};
  }
  return result;
}

struct RestartEffects {
  Duration max_reconnection{};  ///< longest time from the start of an agent's bus until the agent was heard
  double max_cpu_growth_percent = 0;  ///< largest growth of another process's load, in percent of a core
};

/// Kills an agent with kill -9 this many times. The memory of other processes must not grow, and each new
/// agent must be heard.
RestartEffects kill_agent(int times, Duration window) {
  const std::string victim = "agent 6";
  // Sanitizers delay the release of freed memory.
  constexpr double kMaxMemoryGrowth_mb = kIsSanitized ? 40 : 10;
  std::string scenario = shuttles(1000, "restart: [agents]\n");
  scenario.replace(scenario.find("time_limit_s: 100"), 17, "time_limit_s: 3000");
  LaunchedRun run(scenario);
  std::uint64_t heard_incarnation = 0;
  std::vector<Duration> matching;
  // An agent sends commands in every cycle from its start onwards. Its incarnation is the start time of its
  // bus.
  run.bus().subscribe(topics::kCommand, 6, std::function([&](const msg::Command& command) {
                        if (command.header().incarnation() <= heard_incarnation) return;
                        heard_incarnation = command.header().incarnation();
                        const auto started = static_cast<std::int64_t>(heard_incarnation);
                        matching.push_back(run.bus().now() - time_from_ns(started));
                      }));
  const bool drives = run.wait_until([&] { return run.max_speed_mps() > 0.8 && heard_incarnation != 0; });
  INFO(run.output());
  REQUIRE(drives);
  const auto before = measure(run, victim, window);

  matching.clear();
  for (int i = 0; i < times; ++i) {
    INFO("kill " << i << "\n" << run.output().substr(0, 4000));
    const pid_t pid = run.pid_of(victim);
    const std::uint64_t incarnation = heard_incarnation;
    REQUIRE(pid > 0);
    REQUIRE(kill(pid, SIGKILL) == 0);
    REQUIRE(run.wait_until([&] { return run.pid_of(victim) != pid; }));
    REQUIRE(run.wait_until([&] { return heard_incarnation > incarnation; }));
  }

  const auto after = measure(run, victim, window);
  REQUIRE(matching.size() == static_cast<std::size_t>(times));
  std::ranges::sort(matching);
  fmt::print("matching after a restart: median {:.0f} ms, maximum {:.0f} ms, {} restarts\n",
             1e3 * to_seconds(matching[matching.size() / 2]), 1e3 * to_seconds(matching.back()), times);
  RestartEffects result;
  result.max_reconnection = matching.back();
  for (const auto& [name, load] : after) {
    const Load& old = before.at(name);
    result.max_cpu_growth_percent =
        std::max(result.max_cpu_growth_percent, load.cpu_percent - old.cpu_percent);
    fmt::print("{:<12} {:6.1f} -> {:6.1f} MB, {:5.1f} -> {:5.1f} % of a core\n", name, old.memory_mb,
               load.memory_mb, old.cpu_percent, load.cpu_percent);
    CAPTURE(name);
    CHECK(load.memory_mb - old.memory_mb <= kMaxMemoryGrowth_mb);
  }
  return result;
}

}  // namespace

TEST_CASE(
    "an agent that is killed repeatedly reconnects each time, and memory of other processes does not grow") {
  (void)kill_agent(5, 2s);
}

TEST_CASE(
    "an agent that is killed two hundred times reconnects each time, and memory of other processes does not "
    "grow",
    "[.long][slow]") {
  const RestartEffects aftermath = kill_agent(200, 20s);
  CHECK(aftermath.max_reconnection < 500ms);
  CHECK(aftermath.max_cpu_growth_percent <= 1);
}
