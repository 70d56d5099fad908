// SPDX-License-Identifier: Apache-2.0
// How runs of real processes end while robots drive: robots rest before the processes that move and see them
// end, and no robot touches anything meanwhile, by ground truth.
#include <csignal>
#include <map>
#include <set>

#include "common/json/json_text.hpp"
#include "tests/catch.hpp"
#include "tests/faults/external_simulator_run.hpp"

namespace sidestep::run_end_test {
namespace {

using namespace std::chrono_literals;

constexpr double kDriving_mps = 0.8, kAtRest_mps = 0.03;

/// Records how fast the fastest robot was when each process of a run ended.
class ProcessEnds {
 public:
  explicit ProcessEnds(const LaunchedRun& run) : run_(run), pids_(run.children()) {}

  /// Must be called often. Returns whether a process has ended.
  bool observe() {
    for (const auto& [name, pid] : pids_) {
      if (!speeds_mps_.count(name) && !is_running(pid)) speeds_mps_[name] = speed_beside_mps(name);
    }
    return !speeds_mps_.empty();
  }
  bool has_ended(const std::string& process) const { return speeds_mps_.count(process) > 0; }
  /// The processes, other than those that were killed, that ended while a robot drove; for an agent, its own.
  std::set<std::string> early(const std::set<std::string>& killed = {}) const {
    std::set<std::string> result;
    for (const auto& [name, speed_mps] : speeds_mps_) {
      if (speed_mps > kAtRest_mps && !killed.count(name)) result.insert(name);
    }
    return result;
  }

 private:
  /// The speed of the robots that the process moves.
  double speed_beside_mps(const std::string& process) const {
    const std::string agent = "agent ";
    if (!process.starts_with(agent)) return run_.max_speed_mps();
    return run_.speed_mps(static_cast<RobotId>(std::stoul(process.substr(agent.size()))));
  }

  const LaunchedRun& run_;
  std::map<std::string, pid_t> pids_;
  std::map<std::string, double> speeds_mps_;
};

/// Observes a run to its end, and for a second longer, because bases without commands may coast.
void observe_to_end(LaunchedRun& run, ProcessEnds& ends) {
  CHECK(run.wait_until([&] {
    (void)ends.observe();
    return !is_running(run.pid());
  }));
  const Time until = run.bus().now() + 1s;
  while (run.bus().now() < until) {
    run.bus().run_until(run.bus().now() + 2ms);
    (void)ends.observe();
  }
}

void check_contacts(const LaunchedRun& run) {
  CHECK(run.truth().contacts() == 0);
  CHECK(run.max_speed_mps() < kAtRest_mps);
  require_no_violations(run.report());
}

nlohmann::json ending_of(const LaunchedRun& run) { return run.report()["ending"]; }

/// What ends a run: the limit, or a signal to the launcher.
const std::vector<std::string> kEndings{"limit", "SIGINT", "SIGTERM"};

std::vector<std::string> options_for(const std::string& ending) {
  return ending == "limit" ? std::vector<std::string>{"--seconds", "3"} : std::vector<std::string>{};
}

/// Ends a run whose robots drive, and checks that all rest before any of its processes ends. Returns how long
/// that took by the report, in seconds.
double check_ending(LaunchedRun& run, const std::string& ending) {
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() > kDriving_mps; }));
  ProcessEnds ends(run);
  if (ending != "limit") REQUIRE(kill(run.pid(), ending == "SIGINT" ? SIGINT : SIGTERM) == 0);
  observe_to_end(run, ends);
  INFO(run.output());
  CHECK(ends.early().empty());
  check_contacts(run);
  const auto reported = ending_of(run);
  INFO(json_text(reported));
  CHECK(reported["cause"] == (ending == "limit" ? "time limit of 3 s" : "interrupted"));
  CHECK(reported["contacts"] == 0);
  CHECK(reported["problem"].is_null());
  CHECK(run.report()["deaths"].empty());
  CHECK_FALSE(run.printed("was killed"));
  return reported["duration_s"].get<double>();
}

/// Sends a second Ctrl-C while robots come to rest, and checks how the run ends. Returns whether robots still
/// moved when the second one was handled; on a busy machine they may rest before that.
bool check_second_interrupt() {
  ExternalSimulatorRun floor(shipped_scenario("league/crossing"));
  LaunchedRun& run = floor.run();
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() > kDriving_mps; }));
  const pid_t robots = run.pid_of("robots");
  ProcessEnds ends(run);
  REQUIRE(kill(run.pid(), SIGINT) == 0);
  REQUIRE(run.wait_until([&] { return run.printed("interrupted: all robots come to rest"); }));
  // A SIGINT that follows the first one too soon is the same request.
  CHECK(run.wait_until([&] {
    kill(run.pid(), SIGINT);
    return ends.observe();
  }));
  CHECK(run.wait_for_end() == "exit code 1");
  INFO(run.output());
  const bool were_moving = run.printed("ends at once: robot");
  const auto problem = ending_of(run)["problem"];
  if (were_moving) {
    CHECK_THAT(json_text(problem), ContainsSubstring("ended by a second Ctrl-C: robot"));
  } else {
    CHECK(problem.is_null());
    CHECK(ends.early().empty());
  }
  CHECK_FALSE(is_running(run.pid_of("vision")));
  // The process that drives bases still brings them to rest, as if it had been asked alone.
  const Time deadline = run.bus().now() + 10s;
  while (is_running(robots) && run.bus().now() < deadline) run.bus().run_until(run.bus().now() + 2ms);
  CHECK_FALSE(is_running(robots));
  CHECK(run.max_speed_mps() < kAtRest_mps);
  CHECK(run.truth().contacts() == 0);
  return were_moving;
}

}  // namespace

TEST_CASE("at the time limit and at Ctrl-C, all robots rest before any process of the run ends") {
  const std::string ending = GENERATE(from_range(kEndings));
  CAPTURE(ending);
  LaunchedRun run(shuttles(20, ""), options_for(ending));
  const double duration_s = check_ending(run, ending);
  CHECK(duration_s > 0.2);
  CHECK(duration_s < 4.5);
}

TEST_CASE("at the time limit and at Ctrl-C, driven bases rest before any process of the run ends",
          "[both-cores]") {
  const std::string ending = GENERATE(from_range(kEndings));
  CAPTURE(ending);
  ExternalSimulatorRun floor(shipped_scenario("league/crossing"), {}, options_for(ending));
  check_ending(floor.run(), ending);
}

TEST_CASE("without ground truth, vision judges that driven bases have come to rest", "[both-cores]") {
  ExternalSimulatorRun floor(shipped_scenario("league/crossing"), {}, {"--seconds", "3"}, false);
  LaunchedRun& run = floor.run();
  const std::string ended = run.wait_for_end();
  INFO(run.output());
  CHECK(ended == "exit code 1");
  CHECK(run.printed("end: time limit of 3 s; all robots rested after "));
  CHECK(ending_of(run)["problem"].is_null());
  require_no_violations(run.report());
}

TEST_CASE("SIGTERM to an agent stops its robot, and the agent ends with exit code 0 when the robot rests") {
  LaunchedRun run(shuttles(20, ""));
  REQUIRE(run.wait_until([&] { return run.speed_mps(2) > kDriving_mps; }));
  const pid_t agent = run.pid_of("agent 2");
  REQUIRE(kill(agent, SIGTERM) == 0);
  REQUIRE(run.wait_until([&] { return !is_running(agent); }));
  CHECK(run.speed_mps(2) < kAtRest_mps);
  const Time until = run.bus().now() + 2s;
  CHECK(run.wait_until([&] {
    CHECK(run.speed_mps(2) < kAtRest_mps);
    return run.bus().now() > until;
  }));
  REQUIRE(kill(run.pid(), SIGINT) == 0);
  CHECK(run.wait_for_end() == "exit code 1");
  INFO(run.output());
  CHECK(run.printed("agent 2 (pid " + std::to_string(agent) + ") ended: exit code 0"));
  check_contacts(run);
}

TEST_CASE("SIGTERM to the simulator brings its robots to rest before it ends with exit code 0") {
  LaunchedRun run(shuttles(20, ""));
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() > kDriving_mps; }));
  const pid_t simulator = run.pid_of("simulator");
  REQUIRE(kill(simulator, SIGTERM) == 0);
  REQUIRE(run.wait_until([&] { return !is_running(simulator); }));
  CHECK(run.max_speed_mps() < kAtRest_mps);
  CHECK(run.wait_for_end() == "exit code 1");
  INFO(run.output());
  CHECK(run.printed("simulator (pid " + std::to_string(simulator) + ") ended: exit code 0"));
  CHECK(run.truth().contacts() == 0);
}

TEST_CASE("SIGTERM to the process that drives bases brings them to rest before it ends with exit code 0",
          "[both-cores]") {
  ExternalSimulatorRun floor(shipped_scenario("league/crossing"));
  LaunchedRun& run = floor.run();
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() > kDriving_mps; }));
  const pid_t robots = run.pid_of("robots");
  REQUIRE(kill(robots, SIGTERM) == 0);
  REQUIRE(run.wait_until([&] { return !is_running(robots); }));
  CHECK(run.max_speed_mps() < kAtRest_mps);
  CHECK(run.wait_for_end() == "exit code 1");
  INFO(run.output());
  CHECK(run.printed("robots (pid " + std::to_string(robots) + ") ended: exit code 0"));
  check_contacts(run);
}

TEST_CASE("if the coordinator or vision ends or is killed, robots rest and then the run ends") {
  const auto [process, signal] = GENERATE(table<std::string, int>(
      {{"coordinator", SIGTERM}, {"coordinator", SIGKILL}, {"vision", SIGTERM}, {"vision", SIGKILL}}));
  CAPTURE(process, signal);
  LaunchedRun run(shuttles(20, ""));
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() > kDriving_mps; }));
  ProcessEnds ends(run);
  REQUIRE(kill(run.pid_of(process), signal) == 0);
  observe_to_end(run, ends);
  INFO(run.output());
  CHECK(ends.early({process}).empty());
  check_contacts(run);
  CHECK(ending_of(run)["problem"].is_null());
}

TEST_CASE("after SIGKILL of the process that drives bases, the run is judged until they rest",
          "[both-cores]") {
  ExternalSimulatorRun floor(shipped_scenario("league/crossing"));
  LaunchedRun& run = floor.run();
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() > kDriving_mps; }));
  ProcessEnds ends(run);
  REQUIRE(kill(run.pid_of("robots"), SIGKILL) == 0);
  observe_to_end(run, ends);
  INFO(run.output());
  CHECK(ends.early({"robots"}).empty());
  CHECK(run.max_speed_mps() < kAtRest_mps);
  // Nothing but the base can prevent a contact; but the report has each of them.
  CHECK(run.report()["contacts"] == run.truth().contacts());
  CHECK(ending_of(run)["cause"] == "robots died");
  CHECK(ending_of(run)["problem"].is_null());
}

TEST_CASE("a second Ctrl-C ends a run at once and names the robots that still move", "[both-cores]") {
  bool were_moving = false;
  for (int attempt = 1; attempt <= 5 && !were_moving; ++attempt) {
    CAPTURE(attempt);
    were_moving = check_second_interrupt();
  }
  CHECK(were_moving);
}

}  // namespace sidestep::run_end_test
