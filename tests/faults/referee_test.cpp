// SPDX-License-Identifier: Apache-2.0
// The league's referee and the robots that obey it, as real processes.
#include <chrono>
#include <csignal>
#include <fmt/format.h>

#include "common/config/scenario_loader.hpp"
#include "common/league/multicast.hpp"
#include "common/league/referee_packet.hpp"
#include "common/motion/rolling_ball.hpp"
#include "tests/catch.hpp"
#include "tests/faults/launched_run.hpp"
#include "tests/test_endpoint.hpp"

namespace sidestep::referee_faults_test {

using league::RefereeCommand;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr double kMaxSpeed_mps = 1.5, kMinDistance_m = 0.5;  // limits of the league's rules for STOP
constexpr double kAtRest_mps = 0.03;                         // above the noise of a robot at rest

std::string pair(const Vec2& v) { return fmt::format("[{:g}, {:g}]", v.x(), v.y()); }

/// Twenty-two robots that drive back and forth, except for two without goals beside the ball and two whose
/// goals are beside the ball. The ball rolls.
std::string busy_teams() {
  const Scenario scenario = parse_scenario(shipped_scenario("two-teams-22"), "two-teams-22.yaml");
  std::string text =
      "field: {length_m: 12, width_m: 9}\ntime_limit_s: 60\nvision: {columns: 2, rows: 2}\n"
      "ball: {position_m: [-1.5, -2.2], velocity_mps: [0.5, 0.8]}\nrobots:\n";
  for (const RobotSpec& robot : scenario.robots) {
    text += fmt::format("  - {{id: {}, start_m: {}", robot.id, pair(robot.start_m));
    if (robot.id == 9 || robot.id == 25) {
      text += fmt::format(", goals_m: [{}]", pair({0, robot.id == 9 ? 0.4 : -0.4}));
    } else if (robot.id != 10 && robot.id != 26) {
      const std::string there = pair(robot.goals.front().position_m), back = pair(robot.start_m);
      text += fmt::format(", goals_m: [{0}, {1}, {0}, {1}, {0}, {1}, {0}, {1}]", there, back);
    }
    text += "}\n";
  }
  return text;
}

/// A run with a referee whose packets arrive over multicast, ten times a second.
class RefereedRun {
 public:
  RefereedRun() : run_(busy_teams(), {"--seconds", "40"}), sender_(group_.endpoint(), "127.0.0.1") {
    const auto dds = run_.dds_arguments();
    std::vector<std::string> arguments{"--scenario", run_.scenario_file(), "--referee", group_.text()};
    arguments.insert(arguments.end(), dds.begin(), dds.end());
    referee_ = run_.start("referee", "sidestep-referee", arguments);
  }
  LaunchedRun& run() { return run_; }
  pid_t referee() const { return referee_; }
  double max_speed_mps() const { return max_speed_mps_; }
  double min_distance_m() const { return min_distance_m_; }
  /// Time from the first packet of the last command until the robots came to rest.
  double rest_s() const { return rest_s_; }

  /// Repeats a command; returns false if the run ends first. Measures the maximum speed and the minimum
  /// distance once `delay` has passed.
  bool play(RefereeCommand command, Duration duration, Duration delay) {
    const Time begin = next_packet_ = run_.bus().now();
    rest_s_ = 0;
    max_speed_mps_ = 0;
    min_distance_m_ = 1e9;
    return run_.wait_until([&] {
      const Time now = run_.bus().now();
      send(command, now);
      if (now >= begin + delay) measure();
      if (run_.max_speed_mps() > kAtRest_mps) rest_s_ = to_seconds(now - begin);
      return now >= begin + duration;
    });
  }
  void send(RefereeCommand command, Time now) {
    if (now < next_packet_) return;
    next_packet_ = now + milliseconds(100);
    REQUIRE(sender_.send(league::encode({Duration{to_ns(now)}, command, 0, {}, {}})));
  }

 private:
  void measure() {
    const msg::GroundTruth& truth = run_.truth();
    max_speed_mps_ = std::max(max_speed_mps_, run_.max_speed_mps());
    for (const auto& robot : truth.robots()) {
      const double centres_m = std::hypot(robot.x_m() - truth.ball_x_m(), robot.y_m() - truth.ball_y_m());
      min_distance_m_ = std::min(min_distance_m_, centres_m - 0.09 - RollingBall::kRadius_m);
    }
  }

  TestEndpoint group_;
  LaunchedRun run_;
  league::MulticastSender sender_;
  pid_t referee_ = 0;
  Time next_packet_{};
  double max_speed_mps_ = 0, min_distance_m_ = 1e9, rest_s_ = 0;
};

TEST_CASE("twenty-two robots obey the referee's commands received over multicast", "[both-cores][slow]") {
  RefereedRun match;
  LaunchedRun& run = match.run();
  const bool is_driving = run.wait_until([&] {
    match.send(RefereeCommand::kForceStart, run.bus().now());
    return run.max_speed_mps() > kMaxSpeed_mps;
  });
  INFO(run.output());
  REQUIRE(is_driving);
  REQUIRE(match.play(RefereeCommand::kHalt, seconds(5), seconds(2)));
  CHECK(match.max_speed_mps() < kAtRest_mps);
  const double halted_mps = match.max_speed_mps(), rest_s = match.rest_s();
  REQUIRE(match.play(RefereeCommand::kStop, seconds(6), seconds(2)));
  CHECK(match.max_speed_mps() <= kMaxSpeed_mps);
  CHECK(match.min_distance_m() >= kMinDistance_m);
  double fastest_mps = match.max_speed_mps(), nearest_m = match.min_distance_m();
  REQUIRE(match.play(RefereeCommand::kForceStart, seconds(3), seconds(0)));
  CHECK(match.max_speed_mps() > kMaxSpeed_mps);
  REQUIRE(match.play(RefereeCommand::kStop, seconds(6), seconds(2)));
  CHECK(match.max_speed_mps() <= kMaxSpeed_mps);
  CHECK(match.min_distance_m() >= kMinDistance_m);
  fastest_mps = std::max(fastest_mps, match.max_speed_mps());
  nearest_m = std::min(nearest_m, match.min_distance_m());
  WARN("fastest robot " << halted_mps << " m/s in HALT, at rest after " << rest_s << " s; " << fastest_mps
                        << " m/s in STOP; nearest to the ball in STOP " << nearest_m << " m");
  // If the program dies, its last orders stay in force.
  REQUIRE(match.play(RefereeCommand::kHalt, seconds(2), seconds(0)));
  REQUIRE(kill(match.referee(), SIGKILL) == 0);
  REQUIRE(match.play(RefereeCommand::kForceStart, seconds(2), seconds(0)));
  CHECK(match.max_speed_mps() < kAtRest_mps);
  REQUIRE(kill(run.pid(), SIGINT) == 0);
  (void)run.wait_for_end();
  require_no_violations(run.report());
}

}  // namespace sidestep::referee_faults_test
