// SPDX-License-Identifier: Apache-2.0
// Robots in a separate simulator, driven over the Small Size League's
// simulation protocol.
#include "tests/faults/external_simulator_run.hpp"

#include <csignal>

#include "common/json/json_text.hpp"
#include "common/random/rng.hpp"
#include "tests/catch.hpp"

using namespace sidestep;

namespace {

using namespace std::chrono_literals;

std::string outcome(const nlohmann::json& report) {
  return "makespan " + json_text(report["makespan_s"]) + " s, minimum clearance " +
         json_text(report["min_clearance_m"]) + " m, " + json_text(report["denials"]) + " of " +
         json_text(report["proposals"]) + " proposals denied, missed " + json_text(report["missed_cycles"]) +
         " of " + json_text(report["cycles"]) + " cycles";
}

/// Drives the yellow team at random, up to a maximum speed, during this object's lifetime.
class RandomTeam {
 public:
  RandomTeam(const league::Endpoint& port, std::uint32_t robots, double max_mps, std::uint64_t seed)
      : port_(port), rng_(seed), moves_(robots), max_mps_(max_mps) {}

  /// Sends the commands that are due. Must be called often.
  void act(Time now) {
    if (now < due_) return;
    due_ = now + 15ms;
    league::TeamCommands commands;
    for (std::uint32_t number = 0; number < moves_.size(); ++number) {
      Move& move = moves_[number];
      if (now >= move.until) {
        move.until = now + Duration{static_cast<std::int64_t>(rng_.uniform(0.3e9, 2e9))};
        move.velocity = {league::RobotMove::Kind::kLocal,
                         rotated(Vec2(rng_.uniform(0.3, max_mps_), 0), rng_.uniform(-3.14, 3.14)),
                         rng_.uniform(-2.0, 2.0)};
      }
      league::RobotCommand command;
      command.number = number;
      command.move = move.velocity;
      commands.robots.push_back(command);
    }
    (void)socket_.send(encode(commands), port_);
    socket_.receive([this](std::span<const std::byte>, const league::Endpoint&) { ++answers_; });
  }
  std::uint64_t answers() const { return answers_; }

 private:
  struct Move {
    Time until{};
    league::RobotMove velocity;
  };
  league::Endpoint port_;
  league::UnicastSocket socket_{std::nullopt};
  Rng rng_;
  std::vector<Move> moves_;
  double max_mps_;
  Time due_{};
  std::uint64_t answers_ = 0;
};

}  // namespace

TEST_CASE("robots of a third-party simulator all arrive without contact, even with 5 % packet loss",
          "[both-cores][slow]") {
  const auto [name, robots, loss] =
      GENERATE(table<std::string, int, std::string>({{"crossing", 8, "0"},
                                                     {"crossing", 8, "0.05"},
                                                     {"two-teams-22", 22, "0"},
                                                     {"two-teams-22", 22, "0.05"}}));
  ExternalSimulatorRun floor(shipped_scenario("league/" + name), {"--loss", loss});
  const std::string ended = floor.run().wait_for_end();
  INFO(floor.run().output());
  CHECK(ended == "exit code 0");
  const auto report = floor.run().report();
  require_no_violations(report);
  CHECK(report["arrived"] == robots);
  CHECK(floor.run().truth().contacts() == 0);
  WARN(name << ", loss " << loss << ": " << outcome(report));
}

TEST_CASE("without ground truth, arrivals are judged from agents' reports and contacts from vision",
          "[both-cores]") {
  ExternalSimulatorRun floor(shipped_scenario("league/crossing"), {}, {}, false);
  const std::string ended = floor.run().wait_for_end();
  INFO(floor.run().output());
  CHECK(ended == "exit code 0");
  const auto report = floor.run().report();
  require_no_violations(report);
  CHECK(report["arrived"] == 8);
  CHECK(floor.run().truth().robots().empty());
  CHECK(floor.run().printed("positions and contacts from: vision"));
  WARN("judged by vision: " << outcome(report));
}

TEST_CASE("robots continue after the process that drives them is killed and restarted", "[both-cores]") {
  ExternalSimulatorRun floor(shipped_scenario("league/crossing") + "restart: [robots]\n");
  LaunchedRun& run = floor.run();
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() > 0.8; }));
  const pid_t robots = run.pid_of("robots");
  REQUIRE(robots != 0);
  REQUIRE(kill(robots, SIGKILL) == 0);
  const std::string ended = run.wait_for_end();
  INFO(run.output());
  CHECK(ended == "exit code 0");
  const auto report = run.report();
  require_no_violations(report);
  CHECK(report["arrived"] == 8);
  CHECK(run.pid_of("robots") != robots);
  WARN("after a restart of the robots' process: " << outcome(report));
}

TEST_CASE(
    "robots come to rest before the process that drives them ends, whether the run is stopped or the "
    "launcher is killed",
    "[both-cores]") {
  const int signal = GENERATE(SIGINT, SIGKILL);
  CAPTURE(signal);
  ExternalSimulatorRun floor(shipped_scenario("league/crossing"));
  LaunchedRun& run = floor.run();
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() > 0.8; }));
  const pid_t robots = run.pid_of("robots");
  REQUIRE(is_running(robots));
  REQUIRE(kill(run.pid(), signal) == 0);
  const Time begin = run.bus().now();
  while (is_running(robots) && run.bus().now() - begin < 10s) run.bus().run_until(run.bus().now() + 1ms);
  INFO(run.output());
  REQUIRE_FALSE(is_running(robots));
  CHECK(run.max_speed_mps() < 0.05);
  CHECK(run.truth().contacts() == 0);
  const auto is_reported = [&] { return run.report().is_object(); };
  while (!is_reported() && run.bus().now() - begin < 20s) run.bus().run_until(run.bus().now() + 1ms);
  REQUIRE(is_reported());
  require_no_violations(run.report());
}

TEST_CASE("robots continue after the third-party simulator is killed and restarted", "[both-cores]") {
  ExternalSimulatorRun floor(shipped_scenario("league/crossing"));
  LaunchedRun& run = floor.run();
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() > 0.8; }));
  floor.kill_simulator();
  floor.start_simulator();
  const auto incarnation = run.truth().header().incarnation();
  REQUIRE(run.wait_until([&] { return run.truth().header().incarnation() != incarnation; }));
  const std::string ended = run.wait_for_end();
  INFO(run.output());
  const auto report = run.report();
  CHECK(report["arrived"] == 8);
  CHECK(ended == "exit code 0");
  require_no_violations(report);
  WARN("after a restart of the simulator: " << ended << ", " << outcome(report));
}

TEST_CASE("robots never touch each other, and are at rest before randomly driven opponents touch them",
          "[both-cores]") {
  const std::uint64_t seed = 1 + static_cast<std::uint64_t>(time(nullptr)) % 1000;
  CAPTURE(seed);
  ExternalSimulatorRun floor(shipped_scenario("league/eleven-blue"), {"--team-size", "11"},
                             {"--seconds", "60"});
  LaunchedRun& run = floor.run();
  RandomTeam opponents(floor.yellow(), 11, 1.4, seed);
  const bool has_begun = run.wait_until([&] { return run.max_speed_mps() > 0.3; });
  INFO(run.output());
  REQUIRE(has_begun);
  const Time until = run.bus().now() + 30s;
  (void)run.wait_until([&] {
    opponents.act(run.bus().now());
    return run.bus().now() > until;
  });
  CHECK(opponents.answers() > 500);
  CHECK(run.truth().contacts() == 0);
  CHECK(run.truth().crashes_while_moving() == 0);
  WARN("opponents driven at random, seed " << seed << ": " << run.truth().crashes()
                                           << " crashes with robots at rest, minimum clearance "
                                           << run.truth().min_clearance_m() << " m");
}
