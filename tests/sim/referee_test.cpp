// SPDX-License-Identifier: Apache-2.0
// Whole systems that obey the league's referee.
#include "agents/tactics/referee_node.hpp"
#include "common/motion/rolling_ball.hpp"
#include "tests/sim/ordered_system.hpp"

namespace sidestep::referee_test {

using league::RefereeCommand;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr double kMaxSpeed_mps = 1.5, kMinDistance_m = 0.5;  // limits of the league's rules for STOP

/// Twenty-two robots that drive back and forth, except for two without goals beside the ball and two whose
/// goals are beside the ball.
Scenario busy_teams(const BallSpec& ball) {
  Scenario scenario = load_scenario(std::string(SIDESTEP_SOURCE_DIR) + "/deploy/scenarios/two-teams-22.yaml");
  scenario.ball = ball;
  for (std::size_t i = 0; i < scenario.robots.size(); ++i) {
    RobotSpec& robot = scenario.robots[i];
    const Goal there = robot.goals.front(), back{robot.start_m};
    if (i == 10 || i == 21)
      robot.goals.clear();
    else if (i == 9 || i == 20)
      robot.goals = {{{0, i == 9 ? 0.4 : -0.4}}};
    else
      robot.goals = {there, back, there, back, there, back};
  }
  return scenario;
}

/// A system with a referee that repeats its command ten times a second.
struct RefereedSystem {
  OrderedSystem run;
  SimBus bus;
  RefereeNode node;
  Time next_packet;
  double max_speed_mps = 0, min_distance_m = 1e9;  ///< since the last command, after its delay
  double min_late_distance_m = 1e9;                ///< since the last command, after twice its delay

  RefereedSystem(const Scenario& scenario, std::uint64_t seed)
      : run(scenario, seed),
        bus(run.system.network()),
        node(bus, scenario, RefereeSettings{}),
        next_packet(run.system.now()) {}
  void play(RefereeCommand command, Duration duration, Duration delay) {
    const Time begin = run.system.now();
    max_speed_mps = 0;
    min_distance_m = min_late_distance_m = 1e9;
    while (run.system.now() < begin + duration) {
      if (run.system.now() >= next_packet) {
        const Duration sent{to_ns(run.system.now())};
        node.on_datagram(league::encode({sent, command, 0, {}, {}}), {0x7f000001, 4000});
        next_packet += milliseconds(100);
      }
      run.system.run_for(milliseconds(5));
      if (run.system.now() >= begin + delay) measure();
      if (run.system.now() >= begin + 2 * delay)
        min_late_distance_m = std::min(min_late_distance_m, distance_m());
    }
  }
  /// Of the nearest robot's edge from that of the ball.
  double distance_m() const {
    double nearest_m = 1e9;
    for (const auto& [robot, body] : run.bodies)
      nearest_m = std::min(nearest_m, (body.position_m - run.ball_m).norm());
    return nearest_m - run.scenario.radius_m - RollingBall::kRadius_m;
  }
  void measure() {
    for (const auto& [robot, body] : run.bodies)
      max_speed_mps = std::max(max_speed_mps, body.velocity_mps.norm());
    min_distance_m = std::min(min_distance_m, distance_m());
  }
};

TEST_CASE(
    "robots rest after HALT, obey the speed and distance limits after STOP, and continue after FORCE_START") {
  double halted_mps = 0, fastest_mps = 0, nearest_m = 1e9;
  int slow = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    INFO("seed " << seed);
    RefereedSystem match(busy_teams({}), seed);
    match.play(RefereeCommand::kForceStart, seconds(3), seconds(0));
    REQUIRE(match.max_speed_mps > kMaxSpeed_mps);
    match.play(RefereeCommand::kHalt, seconds(3), seconds(1));
    CHECK(match.max_speed_mps < kAtRest_mps);
    halted_mps = std::max(halted_mps, match.max_speed_mps);
    const auto stop = [&] {
      match.play(RefereeCommand::kStop, seconds(6), seconds(2));
      CHECK(match.max_speed_mps <= kMaxSpeed_mps);
      CHECK(match.min_late_distance_m >= kMinDistance_m);
      slow += match.min_distance_m < kMinDistance_m ? 1 : 0;
      fastest_mps = std::max(fastest_mps, match.max_speed_mps);
      nearest_m = std::min(nearest_m, match.min_distance_m);
    };
    stop();
    match.play(RefereeCommand::kForceStart, seconds(4), seconds(0));
    CHECK(match.max_speed_mps > kMaxSpeed_mps);
    stop();
    match.run.require_safe();
  }
  // In a crowd, a robot may need longer than two seconds, because others are in its way.
  CHECK(slow <= 2);
  WARN("fastest robot " << halted_mps << " m/s in HALT, " << fastest_mps
                        << " m/s in STOP; nearest to the ball " << nearest_m << " m");
}

TEST_CASE("robots make way for a ball that rolls between them after STOP") {
  double nearest_m = 1e9;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    INFO("seed " << seed);
    const double angle_rad = 0.6 * static_cast<double>(seed);
    RefereedSystem match(busy_teams({rotated(Vec2(-3, 0.3), angle_rad), rotated(Vec2(1.2, 0), angle_rad)}),
                         seed);
    // The robots are crowded, so some block others.
    match.play(RefereeCommand::kStop, seconds(5), seconds(2));
    CHECK(match.max_speed_mps <= kMaxSpeed_mps);
    CHECK(match.min_distance_m >= 0.3);
    nearest_m = std::min(nearest_m, match.min_distance_m);
    match.play(RefereeCommand::kStop, seconds(4), seconds(0));
    CHECK(match.max_speed_mps <= kMaxSpeed_mps);
    CHECK(match.min_distance_m >= kMinDistance_m);
    match.run.require_safe();
  }
  WARN("nearest to the rolling ball " << nearest_m << " m");
}

}  // namespace sidestep::referee_test
