// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <csignal>

#include "tests/faults/launched_run.hpp"

using namespace sidestep;

TEST_CASE("robots as processes cross the floor over DDS and arrive without a contact") {
  LaunchedRun run(shipped_scenario("crossing"));
  CHECK(run.wait_for_end() == "exit code 0");
  INFO(run.output());
  const auto report = run.report();
  require_untouched(report);
  CHECK(report["arrived"] == 8);
  CHECK(run.children().size() == 11);
  for (const auto& [name, pid] : run.children()) CHECK_FALSE(is_running(pid));
}

TEST_CASE("robots that are seen in camera images cross the floor and arrive without a contact") {
  LaunchedRun run(crossing_images(), {"--seconds", "120"});
  CHECK(run.wait_for_end() == "exit code 0");
  INFO(run.output());
  const auto report = run.report();
  require_untouched(report);
  CHECK(report["arrived"] == 8);
}

TEST_CASE("kill -9 of an agent while it moves: its robot stops, nobody touches it, the report names it") {
  LaunchedRun run(shipped_scenario("crossing"));
  REQUIRE(run.until([&] { return run.speed_mps(2) > 0.8; }));
  REQUIRE(kill(run.pid_of("agent 2"), SIGKILL) == 0);
  CHECK(run.until([&] { return run.speed_mps(2) < 0.02; }));
  CHECK(run.wait_for_end() == "exit code 1");
  INFO(run.output());
  const auto report = run.report();
  require_untouched(report);
  CHECK(report["arrived"] == 7);
  REQUIRE(report["deaths"].size() == 1);
  CHECK(report["deaths"][0].dump().find("agent 2") != std::string::npos);
  CHECK(report["deaths"][0].dump().find("SIGKILL") != std::string::npos);
}

TEST_CASE("kill -9 of the coordinator: all robots stop, and go on to their goals when it is back") {
  LaunchedRun run(shipped_scenario("crossing") + "restart: [coordinator]\n");
  REQUIRE(run.until([&] { return run.speed_mps(0) > 0.8; }));
  const double fastest = run.fastest_mps();
  const std::int64_t killed_at_ns = run.truth().at_ns();
  REQUIRE(kill(run.pid_of("coordinator"), SIGKILL) == 0);
  REQUIRE(run.until([&] { return run.fastest_mps() < 0.03; }));
  const double stopped_s = static_cast<double>(run.truth().at_ns() - killed_at_ns) * 1e-9;
  WARN("all robots at rest "
       << stopped_s << " s after the kill; v/D + one cycle is " << fastest / 5 + 1.0 / 60
       << " s, and versions under way and the lag of bodies and ground truth come on top");
  CHECK(run.wait_for_end() == "exit code 0");
  INFO(run.output());
  const auto report = run.report();
  require_untouched(report);
  CHECK(report["arrived"] == 8);
  CHECK(report["deaths"][0].dump().find("coordinator") != std::string::npos);
}

TEST_CASE("agents and vision that die come back and everybody arrives") {
  LaunchedRun run(shipped_scenario("crossing") + "restart: [agents, vision]\n");
  REQUIRE(run.until([&] { return run.speed_mps(5) > 0.8; }));
  REQUIRE(kill(run.pid_of("agent 5"), SIGKILL) == 0);
  REQUIRE(kill(run.pid_of("vision"), SIGKILL) == 0);
  CHECK(run.wait_for_end() == "exit code 0");
  INFO(run.output());
  require_untouched(run.report());
  CHECK(run.report()["deaths"].size() == 2);
}

TEST_CASE("Ctrl-C stops everything cleanly and still leaves a report") {
  LaunchedRun run(shipped_scenario("crossing"));
  REQUIRE(run.until([&] { return run.fastest_mps() > 0.5; }));
  REQUIRE(kill(run.pid(), SIGINT) == 0);
  CHECK(run.wait_for_end() == "exit code 1");
  CHECK(run.printed("interrupted"));
  CHECK_FALSE(run.printed("was killed"));
  for (const auto& [name, pid] : run.children()) CHECK_FALSE(is_running(pid));
  require_untouched(run.report());
}

TEST_CASE("no process is left behind when the launcher itself is killed") {
  LaunchedRun run(shipped_scenario("crossing"));
  REQUIRE(run.until([&] { return run.fastest_mps() > 0.5; }));
  const auto children = run.children();
  REQUIRE(children.size() == 11);
  REQUIRE(kill(run.pid(), SIGKILL) == 0);
  (void)run.wait_for_end();
  const Time deadline = Time{std::chrono::system_clock::now().time_since_epoch()} + std::chrono::seconds(20);
  const auto any_left = [&] {
    for (const auto& [name, pid] : children) {
      if (is_running(pid)) return true;
    }
    return false;
  };
  while (any_left() && Time{std::chrono::system_clock::now().time_since_epoch()} < deadline) {
  }
  CHECK_FALSE(any_left());
}

TEST_CASE(
    "a start that fails says which process and why, and a wrong scenario is refused before anything starts") {
  LaunchedRun nowhere(shipped_scenario("crossing"), {"--interface", "192.0.2.77"});
  CHECK(nowhere.wait_for_end() == "exit code 1");
  INFO(nowhere.output());
  CHECK(nowhere.printed("192.0.2.77"));

  LaunchedRun wrong(shipped_scenario("crossing") + "speeed: 3\n");
  CHECK(wrong.wait_for_end() == "exit code 2");
  CHECK(wrong.printed("scenario.yaml:"));
  CHECK(wrong.printed("speeed"));
  CHECK(wrong.children().empty());
}
