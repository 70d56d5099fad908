// SPDX-License-Identifier: Apache-2.0
// Driven bases that the operator of a simulator puts elsewhere, and simulators that restart with robots at
// other places.
#include <algorithm>
#include <map>
#include <vector>

#include "common/random/rng.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "tests/catch.hpp"
#include "tests/sim/position_sampler.hpp"

namespace sidestep::teleports_test {

using std::chrono::milliseconds;
using std::chrono::seconds;

enum class Kind : std::uint8_t { kOne, kSeveral, kAll, kRestart };

/// Eight robots like those of deploy/scenarios/league/crossing.yaml, with random starts and goals.
Scenario random_floor(Rng& rng) {
  Scenario scenario;
  scenario.name = "teleports";
  scenario.field = {4.5, 3.5};
  scenario.tracking_bound_m = 0.032;
  scenario.margin_m = 0.068;
  scenario.vision.position_noise_m = 0.0015;
  scenario.vision.miss_probability = 0.02;
  test::PositionSampler starts{rng, scenario.field, {}};
  // A robot that has finished its order stays, so no other robot's goal may be there.
  test::PositionSampler goals{rng, scenario.field, {}};
  for (RobotId id = 0; id < 8; ++id) {
    RobotSpec robot;
    robot.id = id;
    robot.start_m = starts.sample(0.4);
    for (int lap = 0; lap < 3; ++lap) robot.goals.push_back({goals.sample(0.33), std::nullopt});
    scenario.robots.push_back(robot);
  }
  return scenario;
}

/// One run in which robots are put elsewhere.
class TeleportRun {
 public:
  TeleportRun(std::uint64_t seed, Kind kind)
      : rng_(seed),
        scenario_(random_floor(rng_)),
        system_(scenario_, seed, {}, SimSystem::kBegin,
                bases_with_latency(milliseconds(18 + rng_.below(120)))) {
    system_.observer_bus().subscribe(topics::kTruth, [this](const msg::GroundTruth& truth) {
      for (const msg::TrueRobotState& robot : truth.robots())
        bodies_[robot.robot()] = {{robot.x_m(), robot.y_m()}, {robot.vx_mps(), robot.vy_mps()}};
    });
    // Robots find their poses within three seconds.
    system_.run_for(seconds(3) + from_seconds(rng_.uniform(0, 3)));
    if (kind == Kind::kRestart) silence(true);
    place(chosen(kind));
    if (kind != Kind::kRestart) return;
    system_.run_for(from_seconds(rng_.uniform(0, 0.5)));
    silence(false);
  }
  SimSystem& system() { return system_; }
  const std::map<RobotId, State>& bodies() const { return bodies_; }
  const std::vector<RobotId>& placed() const { return placed_; }

 private:
  /// The simulator's cameras are silent while it restarts.
  void silence(bool is_silent) {
    LinkQuality quality;
    quality.is_cut = is_silent;
    system_.set_link("simulator", "vision", quality);
    if (is_silent) system_.run_for(from_seconds(rng_.uniform(0.05, 3)));
  }
  std::vector<RobotId> chosen(Kind kind) {
    std::vector<RobotId> robots;
    for (const RobotSpec& robot : scenario_.robots) robots.push_back(robot.id);
    rng_.shuffle(robots);
    if (kind == Kind::kOne) robots.resize(1);
    if (kind == Kind::kSeveral) robots.resize(2 + rng_.below(4));
    return robots;
  }
  /// Puts robots where they touch nobody.
  void place(const std::vector<RobotId>& robots) {
    constexpr double kApart_m = 0.22;
    test::PositionSampler places{rng_, scenario_.field, {}};
    for (const auto& [robot, state] : bodies_) {
      if (std::ranges::find(robots, robot) == robots.end()) places.taken.push_back(state.position_m);
    }
    for (const RobotId robot : robots) system_.place(robot, places.sample(kApart_m), rng_.uniform(-3.1, 3.1));
    placed_ = robots;
  }

  Rng rng_;
  Scenario scenario_;
  SimSystem system_;
  std::map<RobotId, State> bodies_;
  std::vector<RobotId> placed_;
};

struct Totals {
  int scenes = 0, arrived_scenes = 0;
  std::uint64_t excused = 0;
};

void run_scene(std::uint64_t seed, Totals& totals) {
  const auto kind = static_cast<Kind>(seed % 4);
  CAPTURE(seed, static_cast<int>(kind));
  TeleportRun run(seed, kind);
  const bool have_arrived = run.system().run_until_arrived(run.system().now() + seconds(60));
  const Report report = run.system().metrics().report();
  CHECK(have_arrived);
  for (const auto& [robot, reason] : report.not_arrived)
    WARN("seed " << seed << ": robot " << robot << " has not arrived: " << reason);
  CHECK(report.unexcused_contacts() == 0);
  CHECK(report.audit->violations == 0);
  ++totals.scenes;
  totals.arrived_scenes += have_arrived;
  totals.excused += report.audit->excused_contacts;
}

TEST_CASE("robots that are put elsewhere, and all robots of a simulator that restarts, drive on and arrive") {
  Totals totals;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) run_scene(seed, totals);
  WARN(totals.arrived_scenes << " of " << totals.scenes << " scenes arrived, " << totals.excused
                             << " contacts that the placement forced");
}

TEST_CASE("robots that are put elsewhere arrive in two hundred scenes", "[.long][slow]") {
  Totals totals;
  for (std::uint64_t seed = 1001; seed <= 1200; ++seed) run_scene(seed, totals);
  WARN(totals.arrived_scenes << " of " << totals.scenes << " scenes arrived, " << totals.excused
                             << " contacts that the placement forced");
}

TEST_CASE("a robot that is put elsewhere while it drives brakes after two fixes, before it stops by itself") {
  Scenario scenario;
  scenario.name = "teleport at speed";
  scenario.field = {9, 6};
  scenario.tracking_bound_m = 0.014;
  scenario.margin_m = 0.032;
  scenario.vision.position_noise_m = 0.0015;
  RobotSpec robot;
  robot.start_m = {-4, 0};
  robot.goals = {{Vec2(4, 0), std::nullopt}};
  scenario.robots = {robot};
  SimSystem system(scenario, 1, {}, SimSystem::kBegin, bases_with_latency(milliseconds(40)));
  State body;
  system.observer_bus().subscribe(topics::kTruth, [&](const msg::GroundTruth& truth) {
    if (truth.robots().empty()) return;
    const msg::TrueRobotState& state = truth.robots().front();
    body = {{state.x_m(), state.y_m()}, {state.vx_mps(), state.vy_mps()}};
  });
  const Time limit = system.begin() + seconds(15);
  while (body.velocity_mps.norm() < 1.5 && system.now() < limit) system.run_for(milliseconds(20));
  REQUIRE(body.velocity_mps.norm() >= 1.5);
  SimBus observer(system.network());
  observer.become_observer();
  msg::Feedback report;
  observer.subscribe(topics::kFeedback, 0, [&](const msg::Feedback& message) { report = message; });
  const Vec2 place_m(-2, 2);
  system.place(0, place_m, 0);
  // Two frames, the cameras' delay, a cycle, and the version that is on its way.
  system.run_for(milliseconds(34 + 35 + 17 + 34));
  const std::uint64_t braking = report.executing().version_number();
  system.run_for(milliseconds(50));
  CHECK_FALSE(report.is_off_reference());
  CHECK(report.executing().version_number() == braking);
  const Time limit_of_rest = system.now() + seconds(1);
  while (body.velocity_mps.norm() > 0.05 && system.now() < limit_of_rest) system.run_for(milliseconds(10));
  CHECK((body.position_m - place_m).norm() < 0.3);
  CHECK(system.run_until_arrived(system.now() + seconds(20)));
  CHECK(system.metrics().report().audit->violations == 0);
}

// Nobody orders these robots anywhere. Inflations of a metre would close the floor for all others.
TEST_CASE("the inflation of robots without orders ends where they have been put") {
  Scenario scenario;
  scenario.name = "put among others";
  scenario.field = {6, 4};
  scenario.tracking_bound_m = 0.014;
  scenario.margin_m = 0.032;
  scenario.vision.position_noise_m = 0.0015;
  for (RobotId id = 0; id < 4; ++id) {
    RobotSpec robot;
    robot.id = id;
    robot.start_m = {-2, -0.9 + 0.6 * id};
    scenario.robots.push_back(robot);
  }
  SimSystem system(scenario, 1, {}, SimSystem::kBegin, bases_with_latency(milliseconds(40)));
  SimBus observer(system.network());
  observer.become_observer();
  std::map<RobotId, double> inflations_m;
  for (const RobotSpec& robot : scenario.robots) {
    observer.subscribe(topics::kFeedback, robot.id, [&inflations_m](const msg::Feedback& report) {
      inflations_m[report.header().sender()] = report.executing().inflation_m();
    });
  }
  system.run_for(seconds(4));
  for (RobotId id = 0; id < 4; ++id) system.place(id, {1, -0.6 + 0.4 * id}, 1);
  const auto largest_m = [&] {
    double largest = 0;
    for (const auto& [robot, inflation_m] : inflations_m) largest = std::max(largest, inflation_m);
    return largest;
  };
  const Time limit = system.now() + seconds(5);
  while (largest_m() < 0.9 && system.now() < limit) system.run_for(milliseconds(10));
  REQUIRE(largest_m() > 0.9);
  system.run_for(seconds(3));
  CHECK(inflations_m.size() == 4);
  CHECK(largest_m() == 0);
}

}  // namespace sidestep::teleports_test
