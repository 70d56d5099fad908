// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <unistd.h>

#include "common/json/json_text.hpp"
#include "deploy/audit/audit_totals.hpp"
#include "deploy/trial/simulate/building/building.hpp"
#include "tests/catch.hpp"
#include "tests/faults/launched_run.hpp"

using namespace sidestep;

TEST_CASE("robots run by separate processes cross the field over DDS and arrive without contact") {
  LaunchedRun run(shipped_scenario("crossing"));
  const std::string ended = run.wait_for_end();
  INFO(run.output());
  CHECK(ended == "exit code 0");
  const auto report = run.report();
  require_no_violations(report);
  CHECK(report["arrived"] == 8);
  CHECK(run.children().size() == 11);
  for (const auto& [name, pid] : run.children()) CHECK_FALSE(is_running(pid));
}

TEST_CASE("robots run by separate processes drive through a building whose map has 2,000 x 2,000 cells",
          "[slow]") {
  const auto folder = std::filesystem::temp_directory_path() / ("sidestep-large-" + std::to_string(getpid()));
  BuildingOptions options;
  options.folder = folder.string();
  options.seed = 4;
  options.resolution_m = 0.02;
  options.robots = 6;
  options.goals = 1;
  write_building(options);
  std::ostringstream scenario;
  scenario << std::ifstream(folder / "scenario.yaml").rdbuf();
  LaunchedRun run(std::regex_replace(scenario.str(), std::regex("map: "), "map: " + folder.string() + "/"));
  const std::string ended = run.wait_for_end();
  std::filesystem::remove_all(folder);
  INFO(run.output());
  CHECK(ended == "exit code 0");
  const auto report = run.report();
  require_no_violations(report);
  CHECK(report["arrived"] == 6);
}

TEST_CASE("with --log-level debug, the log of a run lists each registration with level and process") {
  LaunchedRun run(shipped_scenario("crossing"), {"--log-level", "debug"});
  const std::string ended = run.wait_for_end();
  INFO(run.output());
  CHECK(ended == "exit code 0");
  for (int robot = 0; robot < 8; ++robot) {
    CAPTURE(robot);
    CHECK(run.logged("debug   sidestep-coordinator: robot " + std::to_string(robot) +
                     " is registered by its agent"));
    CHECK(run.logged("info    agent-" + std::to_string(robot) + ": arrived at goal 0, the last goal"));
  }
  CHECK(run.logged("info    sidestep-run: all processes are running"));
  const auto report = run.report();
  require_no_violations(report);
  REQUIRE(report["epochs"].size() == 1);
  CHECK(report["epochs"][0]["coordinator"] == "coordinator");
  CHECK(report["epochs"][0]["reason"] == "started");
}

TEST_CASE("robots detected in camera images cross the field and arrive without contact", "[both-cores]") {
  LaunchedRun run(crossing_images(), {"--seconds", "120"});
  const std::string ended = run.wait_for_end();
  INFO(run.output());
  CHECK(ended == "exit code 0");
  const auto report = run.report();
  require_no_violations(report);
  CHECK(report["arrived"] == 8);
}

TEST_CASE(
    "after kill -9 of an agent, its moving robot stops without contact, and the report lists the death") {
  LaunchedRun run(shipped_scenario("crossing"));
  REQUIRE(run.wait_until([&] { return run.speed_mps(2) > 0.8; }));
  REQUIRE(kill(run.pid_of("agent 2"), SIGKILL) == 0);
  CHECK(run.wait_until([&] { return run.speed_mps(2) < 0.02; }));
  const std::string ended = run.wait_for_end();
  INFO(run.output());
  CHECK(ended == "exit code 1");
  const auto report = run.report();
  require_no_violations(report);
  CHECK(report["arrived"] == 7);
  REQUIRE(report["deaths"].size() == 1);
  CHECK(json_text(report["deaths"][0]).find("agent 2") != std::string::npos);
  CHECK(json_text(report["deaths"][0]).find("SIGKILL") != std::string::npos);
}

TEST_CASE("after kill -9 of the coordinator, all robots stop, and reach their goals after its restart") {
  LaunchedRun run(shipped_scenario("crossing") + "restart: [coordinator]\n");
  REQUIRE(run.wait_until([&] { return run.speed_mps(0) > 0.8; }));
  const double max_mps = run.max_speed_mps();
  const std::int64_t killed_at_ns = run.truth().valid_at_ns();
  REQUIRE(kill(run.pid_of("coordinator"), SIGKILL) == 0);
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() < 0.03; }));
  const double stopped_s = static_cast<double>(run.truth().valid_at_ns() - killed_at_ns) * 1e-9;
  WARN("all robots at rest " << stopped_s << " s after the kill; v/D + one cycle is "
                             << max_mps / 5 + 1.0 / 60
                             << " s, plus versions in flight and the lag of bodies and ground truth");
  const std::string ended = run.wait_for_end();
  INFO(run.output());
  CHECK(ended == "exit code 0");
  const auto report = run.report();
  require_no_violations(report);
  CHECK(report["arrived"] == 8);
  CHECK(json_text(report["deaths"][0]).find("coordinator") != std::string::npos);
}

TEST_CASE("if a robot is silent when an epoch begins, the others wait until an operator attests its absence",
          "[slow]") {
  LaunchedRun run(shuttles(20, "restart: [coordinator]\n"), {"--seconds", "20"});
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() > 0.5; }));
  const auto command = [&](std::vector<std::string> arguments) {
    for (const std::string& argument : run.dds_arguments()) arguments.push_back(argument);
    return run.command(arguments);
  };
  bool is_missing = false;
  run.bus().subscribe(topics::kCoordinator, [&](const msg::CoordinatorState& state) {
    is_missing =
        state.notices().size() == 1 && state.notices()[0].robot() == 7 && state.notices()[0].is_missing();
  });
  INFO(run.output());
  CHECK(command({"robot", "absent", "7"}) == "exit code 1");
  CHECK(run.printed("robot 7: the coordinator does not wait for the robot"));
  REQUIRE(command({"fault", "switch-off", "7"}) == "exit code 0");
  REQUIRE(command({"fault", "lift", "7"}) == "exit code 0");
  REQUIRE(kill(run.pid_of("coordinator"), SIGKILL) == 0);
  REQUIRE(run.wait_until([&] { return is_missing && run.max_speed_mps() < 0.03; }));
  CHECK(command({"robot", "absent", "7"}) == "exit code 0");
  CHECK(run.printed("robot 7 counts as absent in epoch"));
  CHECK(run.wait_until([&] { return run.max_speed_mps() > 0.3; }));
  CHECK(run.wait_for_end() == "exit code 1");
  CHECK(run.logged("an operator attests that robot 7 is absent"));
  const auto report = run.report();
  INFO(json_text(report["audit"], 2));
  // Robot 7 rolls on when it is switched off, and may touch a neighbour.
  CHECK(report["contacts"] == report["audit"]["excused_contacts"]);
  for (const auto& excused : report["audit"]["excused"]) {
    CHECK(json_text(excused["robots"]).find('7') != std::string::npos);
  }
  CHECK(report["audit"]["violations"] == 0);
}

TEST_CASE("all robots arrive after an agent and vision die and are restarted") {
  LaunchedRun run(shipped_scenario("crossing") + "restart: [agents, vision]\n");
  REQUIRE(run.wait_until([&] { return run.speed_mps(5) > 0.8; }));
  REQUIRE(kill(run.pid_of("agent 5"), SIGKILL) == 0);
  REQUIRE(kill(run.pid_of("vision"), SIGKILL) == 0);
  const std::string ended = run.wait_for_end();
  INFO(run.output());
  CHECK(ended == "exit code 0");
  require_no_violations(run.report());
  CHECK(run.report()["deaths"].size() == 2);
}

TEST_CASE("Ctrl-C stops all processes cleanly and still writes a report") {
  LaunchedRun run(shipped_scenario("crossing"));
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() > 0.5; }));
  REQUIRE(kill(run.pid(), SIGINT) == 0);
  CHECK(run.wait_for_end() == "exit code 1");
  CHECK(run.printed("interrupted"));
  CHECK_FALSE(run.printed("was killed"));
  for (const auto& [name, pid] : run.children()) CHECK_FALSE(is_running(pid));
  require_no_violations(run.report());
}

TEST_CASE("no process outlives a killed launcher") {
  LaunchedRun run(shipped_scenario("crossing"));
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() > 0.5; }));
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

TEST_CASE("robots continue when the process that directs their run dies, and the run is not judged") {
  LaunchedRun run(shuttles(2, ""));
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() > 0.8; }));
  const auto children = run.children();
  const pid_t director = run.director();
  REQUIRE(director != 0);
  REQUIRE(kill(director, SIGSEGV) == 0);
  REQUIRE(run.wait_until([&] { return run.director() != director && run.director() != 0; }));
  for (const auto& [name, pid] : children) {
    CAPTURE(name);
    CHECK(is_running(pid));
  }
  const std::string ended = run.wait_for_end();
  INFO(run.output());
  CHECK(ended == "exit code " + std::to_string(kExitNotJudged));
  CHECK(run.printed("not judged: the process that observed the run died (signal 11 (SIGSEGV))"));
  const auto report = run.report();
  require_no_violations(report);
  CHECK(report["arrived"] == 8);
  CHECK(report["deaths"].empty());
  CHECK(report["director_deaths"] == std::vector<std::string>{"signal 11 (SIGSEGV)"});
  CHECK(run.children() == children);
}

TEST_CASE("the time limit of a run counts from its start, even if the process that directs it has died") {
  constexpr double kLimit_s = 12;
  LaunchedRun run(shuttles(40, ""), {"--seconds", "12"});
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() > 0.8; }));
  REQUIRE(kill(run.director(), SIGKILL) == 0);
  CHECK(run.wait_for_end() == "exit code 1");
  INFO(run.output());
  const auto report = run.report();
  require_no_violations(report);
  CHECK(run.printed("failed: time limit of 12 s"));
  CHECK(report["wall_clock"]["duration_s"] > kLimit_s);
  CHECK(report["wall_clock"]["duration_s"] < kLimit_s + 2);
}

TEST_CASE(
    "a failed start names the process and the reason, and an invalid scenario is refused before anything "
    "starts") {
  LaunchedRun unreachable(shipped_scenario("crossing"), {"--interface", "192.0.2.77"});
  CHECK(unreachable.wait_for_end() == "exit code 2");
  INFO(unreachable.output());
  CHECK(unreachable.printed("192.0.2.77"));

  LaunchedRun invalid(shipped_scenario("crossing") + "speeed: 3\n");
  CHECK(invalid.wait_for_end() == "exit code 2");
  CHECK(invalid.printed("scenario.yaml:"));
  CHECK(invalid.printed("speeed"));
  CHECK(invalid.children().empty());
}

TEST_CASE("a standby with an outdated scenario is refused and logged, and never takes over") {
  std::string scenario = shuttles(20, "");
  LaunchedRun run(scenario);
  scenario.resize(scenario.rfind("  - {id: 7"));
  const auto yesterday = std::filesystem::path(run.scenario_file()).replace_filename("yesterday.yaml");
  std::ofstream(yesterday) << scenario;
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() > 0.8; }));
  std::vector<std::string> arguments{"--standby", "--number", "1", "--scenario", yesterday.string()};
  for (const std::string& argument : run.dds_arguments()) arguments.push_back(argument);
  const Time begin = run.bus().now();
  REQUIRE(run.start("coordinator 1", "sidestep-coordinator", arguments) > 0);
  INFO(run.output());
  REQUIRE(run.wait_until([&] {
    return run.printed("refuses coordinator 1, which has different rules: robots.blue is 0-6 instead of 0-7");
  }));
  WARN("named " << to_seconds(run.bus().now() - begin) << " s after the start of its process");
  // Coordinators of both sides report the difference.
  CHECK(run.wait_until([&] {
    return run.printed(
        "coordinator-1: refuses coordinator, which has different rules: robots.blue is 0-7 instead of 0-6");
  }));
  CHECK(run.wait_until([&] {
    return run.logged("agent-0: refuses coordinator 1, which has different rules: robots.blue is 0-6");
  }));
  // Every process publishes its counters within a second.
  std::vector<std::string> echo{"topic", "echo", "counters", "--count", "25"};
  for (const std::string& argument : run.dds_arguments()) echo.push_back(argument);
  CHECK(run.command(echo) == "exit code 0");
  CHECK(run.printed("\"other_rules\""));
  REQUIRE(kill(run.pid_of("coordinator"), SIGKILL) == 0);
  CHECK(run.wait_until([&] { return run.max_speed_mps() < 0.03; }));
  const std::string ended = run.wait_for_end();
  INFO(run.output());
  CHECK(ended == "exit code 1");
  require_no_violations(run.report());
  CHECK(json_text(run.report()["failure"]).find("coordinator died") != std::string::npos);
  CHECK(run.report()["mismatches"].contains("coordinator 1"));
}
