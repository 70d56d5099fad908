// SPDX-License-Identifier: Apache-2.0
// Opponents at rest beside the starts and goals of robots: they may start to move at any time.
#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "common/messaging/order_codec.hpp"
#include "common/random/rng.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "tests/catch.hpp"
#include "tests/sim/position_sampler.hpp"

namespace sidestep::strangers_test {

using std::chrono::seconds;

/// A robot can rest at a goal that is farther away from every stranger: it may still approach at a walking
/// pace, although observations are up to 0.1 s old.
constexpr double kReachable_m = 0.5;
constexpr double kAtRest_mps = 0.05, kAtGoal_m = 0.02;
constexpr Duration kStartUp = seconds(2), kNamedWithin = seconds(1);

struct Scene {
  Scenario scenario;
  std::map<RobotId, bool> can_arrive;
};

bool is_far(const Vec2& place_m, const std::vector<Vec2>& others_m, double distance_m) {
  return std::ranges::all_of(others_m, [&](const Vec2& o) { return (o - place_m).norm() >= distance_m; });
}

/// Two robots, and one or two strangers beside each start and some goals, 0.22 to 0.6 m away.
Scene random_scene(std::uint64_t seed) {
  Rng rng(seed);
  Scene scene;
  Scenario& scenario = scene.scenario;
  scenario.name = "strangers";
  scenario.field = {7, 6};
  scenario.vision.delay = from_seconds(rng.uniform(0.015, 0.06));
  // Strangers could enclose a robot at the edge of the field.
  const Field inner{scenario.field.length_m - 1.4, scenario.field.width_m - 1.4};
  test::PositionSampler places{rng, inner, {}};
  std::vector<Vec2> strangers_m;
  for (RobotId id = 0; id < 2; ++id) {
    RobotSpec robot;
    robot.id = id;
    robot.start_m = places.sample(1.3);
    robot.goals = {{places.sample(1.3), std::nullopt}};
    scenario.robots.push_back(robot);
  }
  const auto add_beside = [&](const Vec2& place_m) {
    for (int attempt = 0; attempt < 100; ++attempt) {
      const double distance_m = rng.uniform(0.22, 0.6), angle_rad = rng.uniform(-3.15, 3.15);
      const Vec2 at_m = place_m + rotated({distance_m, 0}, angle_rad);
      if (!is_far(at_m, strangers_m, 0.2) || !scenario.field.contains(at_m, 0.1)) continue;
      strangers_m.push_back(at_m);
      scenario.opponents.push_back({scenario.radius_m, 1, {at_m}});
      return;
    }
  };
  for (const RobotSpec& robot : scenario.robots) {
    for (std::uint64_t count = 1 + rng.below(2); count > 0; --count) add_beside(robot.start_m);
    if (rng.chance(0.5)) add_beside(robot.goals.front().position_m);
  }
  for (const RobotSpec& robot : scenario.robots)
    scene.can_arrive[robot.id] = is_far(robot.goals.front().position_m, strangers_m, kReachable_m);
  return scene;
}

/// Watches whether the cause is named in time whenever a robot stands away from its goal.
class CauseWatch {
 public:
  CauseWatch(SimSystem& system, const Scenario& scenario) : system_(system), scenario_(scenario) {
    system.observer_bus().subscribe(topics::kOrderStatus, [this](const msg::OrderStatus& status) {
      const auto report = decode(status);
      blockages_[status.robot()] = report ? report->blockage : std::nullopt;
      if (report && report->blockage) reasons_.insert(report->blockage->reason);
    });
    system.observer_bus().subscribe(topics::kTruth, [this](const msg::GroundTruth& truth) {
      for (const msg::TrueRobotState& robot : truth.robots()) watch(robot);
    });
  }
  int unnamed() const { return unnamed_; }
  const std::set<msg::BlockReason>& reasons() const { return reasons_; }
  const std::optional<Blockage>& blockage(RobotId robot) { return blockages_[robot]; }

 private:
  void watch(const msg::TrueRobotState& robot) {
    const Time now = system_.now();
    const Vec2 at_m(robot.x_m(), robot.y_m());
    const bool is_done =
        (at_m - scenario_.robots.at(robot.robot()).goals.front().position_m).norm() < kAtGoal_m;
    const bool is_named = blockages_[robot.robot()].has_value();
    const bool stands = std::hypot(robot.vx_mps(), robot.vy_mps()) < kAtRest_mps;
    Time& since = silent_since_.try_emplace(robot.robot(), system_.begin() + kStartUp).first->second;
    if (is_done || is_named || !stands) since = std::max(since, now);
    if (now - since <= kNamedWithin) return;
    ++unnamed_;
    since = now;
  }
  SimSystem& system_;
  const Scenario& scenario_;
  std::map<RobotId, std::optional<Blockage>> blockages_;
  std::set<msg::BlockReason> reasons_;    // all that were named
  std::map<RobotId, Time> silent_since_;  // since when a robot stands without a named cause
  int unnamed_ = 0;
};

struct Totals {
  int robots = 0, arrived = 0, could_not = 0;
  std::set<msg::BlockReason> reasons{};
};

void run_scene(std::uint64_t seed, Totals& totals) {
  CAPTURE(seed);
  const Scene scene = random_scene(seed);
  SimSystem system(scene.scenario, seed);
  CauseWatch causes(system, scene.scenario);
  (void)system.run_until_arrived(system.begin() + seconds(40));
  const Report report = system.metrics().report();
  CHECK(report.contacts == 0);
  CHECK(report.crashes_while_moving == 0);
  CHECK(report.firmware_violations == 0);
  CHECK(report.audit->violations == 0);
  CHECK(causes.unnamed() == 0);
  totals.reasons.insert(causes.reasons().begin(), causes.reasons().end());
  for (const RobotSpec& robot : scene.scenario.robots) {
    CAPTURE(robot.id);
    const bool has_arrived = report.arrival_s.at(robot.id).has_value();
    ++totals.robots;
    totals.arrived += has_arrived;
    if (has_arrived) continue;
    CHECK_FALSE(scene.can_arrive.at(robot.id));
    ++totals.could_not;
    CHECK(causes.blockage(robot.id));
  }
}

TEST_CASE("robots creep away from strangers that stand beside them, arrive if they can, and name the cause") {
  Totals totals;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) run_scene(seed, totals);
  WARN(totals.arrived << " of " << totals.robots << " robots arrived, " << totals.could_not << " could not");
  CHECK(totals.arrived > totals.robots / 2);
  CHECK(totals.could_not > 0);
}

TEST_CASE("a robot that sees other strangers from other places of its way does not turn around for ever") {
  Totals totals;
  run_scene(1162, totals);
  CHECK(totals.arrived == totals.robots);
}

TEST_CASE("a robot that gives way among strangers names the robot for which it waits") {
  Totals totals;
  run_scene(1393, totals);
  CHECK(totals.arrived == totals.robots);
  CHECK(totals.reasons.contains(msg::BlockReason::BLOCK_PASSING_ROBOT));
}

// Seeds 1 to 1000 are not used, because creeping was tuned on them.
TEST_CASE("robots leave standing strangers in five hundred scenes", "[.long][slow]") {
  Totals totals;
  for (std::uint64_t seed = 1001; seed <= 1500; ++seed) run_scene(seed, totals);
  WARN(totals.arrived << " of " << totals.robots << " robots arrived, " << totals.could_not << " could not");
}

TEST_CASE("the log, the order's status and the report name the stranger that keeps a robot from driving") {
  Scenario scenario;
  scenario.name = "enclosed";
  scenario.field = {6, 4};
  RobotSpec robot;
  robot.goals = {{Vec2(2, 0), std::nullopt}};
  scenario.robots = {robot};
  for (const Vec2& at_m : {Vec2(0.25, 0), Vec2(-0.25, 0.02), Vec2(0.02, 0.25), Vec2(-0.02, -0.25)})
    scenario.opponents.push_back({scenario.radius_m, 1, {at_m}});
  SimSystem system(scenario, 1);
  int named = 0, turning = 0;
  system.on_event(LogLevel::kInfo, [&](const std::string&, const LogEvent& event) {
    named += event.text.find("blocked: a stranger 0.25 m away, who may move at 1.5 m/s") != std::string::npos;
    turning += event.text.find("turning right") != std::string::npos;
  });
  CauseWatch causes(system, scenario);
  system.run_for(seconds(6));
  CHECK(named > 0);
  CHECK(turning == 0);
  REQUIRE(causes.blockage(0));
  CHECK(causes.blockage(0)->reason == msg::BlockReason::BLOCK_STRANGER);
  CHECK(causes.unnamed() == 0);
  const Report report = system.metrics().report();
  CHECK_THAT(report.not_arrived.at(0), StartsWith("a stranger 0.25 m away, who may move at 1.5 m/s"));
  CHECK(report.crashes == 0);
}

}  // namespace sidestep::strangers_test
