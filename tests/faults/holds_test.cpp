// SPDX-License-Identifier: Apache-2.0
// Holds, with real processes.
#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <regex>
#include <signal.h>

#include "common/client/order_client.hpp"
#include "common/config/scenario_loader.hpp"
#include "common/protocol/process_names.hpp"
#include "tests/catch.hpp"
#include "tests/faults/launched_run.hpp"
#include "tests/needs_root.hpp"

namespace sidestep::holds_test {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr double kAtRest_mps = 0.03;

/// The scenario of the two teams, which drive back and forth.
std::string two_teams_back_and_forth() {
  std::string text;
  const std::regex robot("(.*start_m: )(\\[[^\\]]*\\])(.*goals_m: )\\[(\\[[^\\]]*\\])\\](.*)");
  std::istringstream lines(shipped_scenario("two-teams-22"));
  for (std::string line; std::getline(lines, line);) {
    std::smatch m;
    if (std::regex_match(line, m, robot)) {
      std::string goals = m[4].str();
      for (int i = 0; i < 30; ++i) goals += ", " + m[2].str() + ", " + m[4].str();
      line = m[1].str() + m[2].str() + m[3].str() + "[" + goals + "]" + m[5].str();
    }
    text += line + "\n";
  }
  return std::regex_replace(text, std::regex("time_limit_s: 60"), "time_limit_s: 600");
}

/// Waits until all robots have rested for half a second. Returns the seconds from now until the last motion.
double seconds_to_rest(LaunchedRun& run, Time from) {
  Time moved_at = from;
  REQUIRE(run.wait_until([&] {
    const Time at = time_from_ns(run.truth().valid_at_ns());
    if (run.max_speed_mps() > kAtRest_mps) moved_at = std::max(moved_at, at);
    return at - moved_at > milliseconds(500) && at - from > milliseconds(500);
  }));
  return to_seconds(moved_at - from);
}

struct Delays {
  std::vector<double> seconds;
  std::string to_text() {
    std::ranges::sort(seconds);
    return fmt::format("{} times: median {:.3f} s, longest {:.3f} s", seconds.size(),
                       seconds[seconds.size() / 2], seconds.back());
  }
};

void check_holds(LaunchedRun& run, double extra_s) {
  const Scenario scenario = parse_scenario(two_teams_back_and_forth(), "teams.yaml");
  const double braking_s = scenario.limits.speed_mps / scenario.limits.deceleration_mps2;
  OrderClient client(run.bus(), static_cast<ClientId>(Sender::kOperator));
  Delays published, entered;
  for (int i = 0; i < 40; ++i) {
    INFO("hold " << i);
    REQUIRE(run.wait_until([&] { return run.max_speed_mps() > 0.95 * scenario.limits.speed_mps; }));
    const Time begin = run.bus().now();
    if (i % 2 == 0) {
      client.hold(kAllRobots);
      published.seconds.push_back(seconds_to_rest(run, begin));
      client.resume(kAllRobots);
    } else {
      std::vector<std::string> arguments{"hold", "all"};
      for (const std::string& argument : run.dds_arguments()) arguments.push_back(argument);
      CHECK(run.command(arguments) == "exit code 0");
      entered.seconds.push_back(seconds_to_rest(run, begin));
      client.resume(kAllRobots);
    }
  }
  REQUIRE(kill(run.pid(), SIGINT) == 0);
  CHECK(run.wait_for_end() != "");
  const auto report = run.report();
  CHECK(report["contacts"] == 0);
  CHECK(report["audit"]["violations"] == 0);
  const double budget_s = braking_s + 3 * to_seconds(scenario.cycle) + extra_s;
  WARN("from publication to rest, " << published.to_text() << ", budget " << budget_s << " s");
  WARN("from the command's start to rest, " << entered.to_text() << ", budget " << 1 + braking_s << " s");
  // Agents that wait for a processor propose farther ahead, so their robots stop later.
  CHECK(published.seconds.back() <= budget_s + 0.5);
}

TEST_CASE("22 robots come to rest quickly when held at full speed over DDS, 40 times", "[.long][slow]") {
  LaunchedRun run(two_teams_back_and_forth());
  check_holds(run, 0);
}

TEST_CASE(
    "22 robots on three hosts with 5 % packet loss come to rest quickly when held at full speed, 40 times",
    "[.long][slow]") {
  SIDESTEP_NEEDS_ROOT();
  const auto run = LaunchedRun::on_namespaces(two_teams_back_and_forth());
  for (const char* host : {"floor", "east", "west"}) {
    const std::string name = "sidestep-" + std::to_string(run->pid()) + "-" + host;
    REQUIRE(run->command({"fault", "link", name, "--loss", "0.05"}) == "exit code 0");
  }
  check_holds(*run, 0.2);
}

TEST_CASE("held robots stay at rest although the coordinator and all agents are killed and a new agent joins",
          "[slow]") {
  LaunchedRun run(shuttles(20, "restart: [coordinator, agents]\n"), {"--seconds", "25"});
  OrderClient client(run.bus(), client_id("holder"));
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() > 1; }));
  INFO(run.output());
  client.hold(kAllRobots);
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() < kAtRest_mps; }));
  double fastest_mps = 0;
  const auto watch = [&](Duration duration) {
    const Time end = run.bus().now() + duration;
    REQUIRE(run.wait_until([&] {
      fastest_mps = std::max(fastest_mps, run.max_speed_mps());
      return run.bus().now() > end;
    }));
  };
  REQUIRE(kill(run.pid_of("coordinator"), SIGKILL) == 0);
  watch(seconds(2));
  for (RobotId robot = 0; robot < 8; ++robot) REQUIRE(kill(run.pid_of(agent_process(robot)), SIGKILL) == 0);
  watch(seconds(3));
  std::vector<std::string> arguments{"--robot", "3", "--scenario", run.scenario_file()};
  for (const std::string& argument : run.dds_arguments()) arguments.push_back(argument);
  run.start("new agent 3", "sidestep-agent", arguments);
  watch(seconds(3));
  CHECK(fastest_mps < kAtRest_mps);
  client.resume(kAllRobots);
  CHECK(run.wait_until([&] { return run.max_speed_mps() > 0.3; }));
  CHECK(run.wait_for_end() == "exit code 1");  // no robot has visited all its goals
  CHECK(run.report()["contacts"] == 0);
  CHECK(run.report()["audit"]["violations"] == 0);
}

}  // namespace sidestep::holds_test
