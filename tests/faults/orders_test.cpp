// SPDX-License-Identifier: Apache-2.0
// Orders at run time, with real processes.
#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <signal.h>

#include "common/client/order_client.hpp"
#include "common/protocol/process_names.hpp"
#include "common/random/rng.hpp"
#include "tests/catch.hpp"
#include "tests/faults/launched_run.hpp"

namespace sidestep::orders_faults_test {

using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;

constexpr int kRobots = 8, kColumns = 6, kRows = 5;

/// Robots without goals, on two sides of the field.
std::string waiting_robots() {
  std::string text =
      "field: {length_m: 6, width_m: 5}\ncoordinators: 2\nrestart: [agents, coordinator]\nrobots:\n";
  for (int i = 0; i < kRobots; ++i)
    text += fmt::format("  - {{id: {}, start_m: [{}, {}]}}\n", i, i % 2 ? 2.4 : -2.4, -1.5 + 0.5 * (i / 2));
  return text;
}

/// Sends robots to random positions that do not overlap.
class RandomClient {
 public:
  RandomClient(DdsBus& bus, std::uint64_t seed) : client_(bus, client_id("random")), rng_(seed) {}

  void send_one() {
    const auto robot = static_cast<RobotId>(rng_.below(kRobots));
    int place = 0;
    do {
      place = static_cast<int>(rng_.below(kColumns * kRows));
    } while (std::ranges::count(places_, place) > 0);
    places_[robot] = place;
    const Vec2 position(-2 + 0.8 * (place % kColumns), -1.6 + 0.8 * (place / kColumns));
    open_.push_back(client_.go(robot, {{position}}));
    ++sent_;
  }
  /// Forgets orders that have ended. Returns whether none remain.
  bool is_over() {
    std::erase_if(open_, [this](OrderHandle number) {
      const OrderPhase phase = client_.find(number)->phase;
      arrived_ += phase == OrderPhase::kArrived;
      refused_ += phase == OrderPhase::kRefused;
      return is_final(phase);
    });
    return open_.empty();
  }
  int sent() const { return sent_; }
  int arrived() const { return arrived_; }
  int refused() const { return refused_; }
  Rng& rng() { return rng_; }

 private:
  OrderClient client_;
  Rng rng_;
  std::array<int, kRobots> places_{-1, -1, -1, -1, -1, -1, -1, -1};
  std::vector<OrderHandle> open_;
  int sent_ = 0, arrived_ = 0, refused_ = 0;
};

void check_random_goals(Duration duration) {
  LaunchedRun run(waiting_robots());
  RandomClient client(run.bus(), 1);
  int kills = 0;
  Time next_order = run.bus().now(), next_kill = next_order + seconds(3);
  const Time end = next_order + duration;
  while (run.bus().now() < end) {
    REQUIRE(run.wait_until([&] { return run.bus().now() >= std::min({next_order, next_kill, end}); }));
    if (run.bus().now() >= next_order) {
      client.send_one();
      (void)client.is_over();
      next_order += milliseconds(400);
    }
    if (run.bus().now() >= next_kill) {
      const auto number = static_cast<std::uint32_t>(client.rng().below(kRobots + 2));
      const pid_t pid = run.pid_of(
          number < kRobots ? agent_process(number) : coordinator_process(static_cast<int>(number - kRobots)));
      if (pid != 0 && is_running(pid)) kills += kill(pid, SIGKILL) == 0;
      next_kill += seconds(3);
    }
  }
  CHECK(run.wait_until([&] { return client.is_over(); }));
  REQUIRE(kill(run.pid(), SIGINT) == 0);
  const std::string ended = run.wait_for_end();
  INFO(run.output());
  CHECK(ended == "exit code 0");
  WARN(client.sent() << " orders, " << client.arrived() << " arrived, "
                     << client.sent() - client.arrived() - client.refused() << " replaced, "
                     << client.refused() << " refused; " << kills << " processes killed");
  CHECK(client.refused() == 0);
  CHECK(client.arrived() > client.sent() / 4);
  require_no_violations(run.report());
}

TEST_CASE("a client learns the outcome of every order while agents and coordinators are killed") {
  check_random_goals(seconds(12));
}

TEST_CASE(
    "a client learns the outcome of every order for ten minutes while agents and coordinators are killed",
    "[.long][slow]") {
  check_random_goals(minutes(10));
}

TEST_CASE(
    "a run on demand goes on when an agent dies while all robots are at rest, and orders outlast their "
    "commands") {
  LaunchedRun run(
      "field: {length_m: 6, width_m: 5}\nrobots:\n  - {id: 0, start_m: [-2, 0]}\n  - {id: 1, start_m: [0, "
      "0]}\n"
      "  - {id: 2, start_m: [2, 0]}\n");
  REQUIRE(run.wait_until([&] { return run.printed("the coordinator grants"); }));
  REQUIRE(kill(run.pid_of("agent 2"), SIGKILL) == 0);
  REQUIRE(run.wait_until([&] { return run.printed("agent 2 (pid"); }));
  // Longer than after a death that ends a run.
  const Time killed = run.bus().now();
  CHECK(run.wait_until([&] { return run.bus().now() - killed > seconds(4); }));
  const auto on_run = [&](std::vector<std::string> arguments) {
    for (const std::string& argument : run.dds_arguments()) arguments.push_back(argument);
    return arguments;
  };
  CHECK(run.command(on_run({"go", "0", "-2,1", "--wait", "--timeout", "20"})) == "exit code 0");
  CHECK(run.command(on_run({"hold", "1"})) == "exit code 0");
  const pid_t waiting = run.start("go", "sidestep", on_run({"go", "1", "0,1", "--wait"}));
  REQUIRE(run.wait_until([&] { return run.printed("go 1: not driving: it is held by the operator"); }));
  REQUIRE(kill(waiting, SIGINT) == 0);
  REQUIRE(run.wait_until([&] { return run.exit_reason("go").has_value(); }));
  CHECK(run.exit_reason("go") == "exit code 1");
  CHECK(run.printed("the order of robot 1 stays in force; `sidestep cancel 1` ends it"));
  REQUIRE(kill(run.pid(), SIGINT) == 0);
  CHECK(run.wait_for_end() == "exit code 0");
  INFO(run.output());
  CHECK(run.report()["passed"] == true);
  CHECK(run.report()["deaths"][0]["process"] == "agent 2");
}

TEST_CASE("with --until-idle a run passes only if all robots have finished their orders") {
  const bool has_unfinished = GENERATE(false, true);
  CAPTURE(has_unfinished);
  LaunchedRun run(waiting_robots(), {"--until-idle", "--seconds", "20"});
  const auto command = [&](std::vector<std::string> arguments) {
    for (const std::string& argument : run.dds_arguments()) arguments.push_back(argument);
    return run.command(arguments);
  };
  REQUIRE(run.wait_until([&] { return run.printed("the coordinator grants"); }));
  if (has_unfinished) {
    CHECK(command({"fault", "lift", "4"}) == "exit code 0");
    CHECK(command({"zone", "1", "0,0", "--radius", "0.5"}) == "exit code 0");
    CHECK(command({"go", "5", "0,0"}) == "exit code 0");
  } else {
    CHECK(command({"go", "5", "2,1.5"}) == "exit code 0");
  }
  const std::string ended = run.wait_for_end();
  INFO(run.output());
  CHECK(ended == (has_unfinished ? "exit code 1" : "exit code 0"));
  const auto report = run.report();
  CHECK(report["passed"] == !has_unfinished);
  CHECK(report["not_arrived"].size() == (has_unfinished ? 2 : 0));
  if (!has_unfinished) return;
  CHECK(report["failure"] == "0 of 2 arrived");
  CHECK(report["not_arrived"]["4"] == "it is off the floor");
  CHECK_THAT(report["not_arrived"].value("5", ""), StartsWith("zone 1 covers its goal"));
}

TEST_CASE(
    "robots held from the command line stay held until they are resumed, although the coordinator is "
    "killed") {
  LaunchedRun run(shuttles(20, "restart: [coordinator]\n"), {"--seconds", "28"});
  const auto command = [&](std::vector<std::string> arguments) {
    for (const std::string& argument : run.dds_arguments()) arguments.push_back(argument);
    return run.command(arguments);
  };
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() > 1; }));
  INFO(run.output());
  const Time begin = run.bus().now();
  CHECK(command({"hold", "all"}) == "exit code 0");
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() < 0.03; }));
  const double held_s = to_seconds(run.bus().now() - begin);
  WARN("all robots at rest " << held_s << " s after the command was started");
  REQUIRE(kill(run.pid_of("coordinator"), SIGKILL) == 0);
  const Time killed = run.bus().now();
  double fastest_mps = 0;
  REQUIRE(run.wait_until([&] {
    fastest_mps = std::max(fastest_mps, run.max_speed_mps());
    return run.bus().now() - killed > seconds(4);
  }));
  CHECK(fastest_mps < 0.03);
  CHECK(command({"go", "0", "0,0", "--wait", "--timeout", "3"}) == "exit code 1");
  CHECK(run.printed("go 0: not driving: it is held by the operator"));
  CHECK(run.printed("after 3 s: go 0: not driving: it is held by the operator"));
  CHECK(run.printed("the order of robot 0 stays in force; `sidestep cancel 0` ends it"));
  CHECK(command({"resume", "all", "--client", "stranger"}) == "exit code 0");
  CHECK(run.printed("still held: all robots by the operator"));
  CHECK(command({"resume", "all"}) == "exit code 0");
  CHECK(run.wait_until([&] { return run.max_speed_mps() > 0.3; }));
  CHECK(command({"go", "9", "0,0"}) == "exit code 1");
  CHECK(run.printed("go 9: refused, the scenario has no such robot"));
  CHECK(command({"go", "0", "0,0", "--wait", "--timeout", "0.5"}) == "exit code 1");
  CHECK(run.printed("after 0.5 s: go 0: "));
  CHECK(command({"zone", "7", "--remove"}) == "exit code 1");
  CHECK(run.printed("remove zone 7: refused, the operator has no zone 7; there are no zones"));
  CHECK(command({"zone", "7", "9,9", "--radius", "0.1"}) == "exit code 0");
  CHECK(command({"zone", "7", "--remove"}) == "exit code 0");
  CHECK(run.wait_for_end() == "exit code 1");  // no robot has visited all its goals
  CHECK(run.report()["contacts"] == 0);
  CHECK(run.report()["audit"]["violations"] == 0);
}

}  // namespace sidestep::orders_faults_test
