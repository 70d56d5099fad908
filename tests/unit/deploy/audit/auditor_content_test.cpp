// SPDX-License-Identifier: Apache-2.0
// The content of granted versions, compared with dense samples of their motion.
#include <algorithm>
#include <cmath>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"
#include "tests/unit/deploy/audit/stage.hpp"

namespace sidestep::auditor_content_test {

using namespace std::chrono_literals;

/// Calls back with the state at many times of a version, including just before and after the ends of its
/// phases.
void each_sample(const msg::Version& version, const std::function<void(const AuditPath::Node&)>& use) {
  const AuditPath path(version);
  for (int i = 0; i < path.phase_count(); ++i) {
    const double begin_s = path.phase(i).elapsed_s, length_s = path.phase(i + 1).elapsed_s - begin_s;
    for (int k = 0; k <= 200; ++k) use(path.at_s(begin_s + std::clamp(k / 200.0, 1e-9, 1 - 1e-9) * length_s));
  }
  use(path.at_s(path.duration_s()));
}

/// The largest acceleration relative to the limit, which is an ellipse with its longer half against the
/// velocity.
double effort(const AuditPath::Node& n, const MotionLimits& limits) {
  const Vec2 v(n.vx, n.vy), a(n.ax, n.ay);
  if (v.norm() < 1e-3) return 0;
  const Vec2 ahead = v.normalized(), left(-ahead.y(), ahead.x());
  const double along = a.dot(ahead), across = a.dot(left);
  const double most_along = along > 0 ? limits.acceleration_mps2 : limits.deceleration_mps2;
  return Vec2(along / most_along, across / limits.acceleration_mps2).norm();
}

/// Appends a braking phase, so that the version ends at rest.
void brake(msg::Version& version, double deceleration_mps2) {
  const AuditPath::Node end = AuditPath(version).last();
  const double speed = std::hypot(end.vx, end.vy);
  if (speed == 0) return;
  msg::MotionPhase& phase = version.phases()[version.phase_count()];
  phase.duration_ns(std::llround(speed / deceleration_mps2 * 1e9));
  const double seconds = static_cast<double>(phase.duration_ns()) * 1e-9;
  phase.ax_mps2(-end.vx / seconds);
  phase.ay_mps2(-end.vy / seconds);
  version.phase_count(static_cast<std::uint8_t>(version.phase_count() + 1));
}

void append(msg::Version& version, double seconds, const Vec2& acceleration_mps2) {
  msg::MotionPhase& phase = version.phases()[version.phase_count()];
  phase.duration_ns(std::llround(seconds * 1e9));
  phase.ax_mps2(acceleration_mps2.x());
  phase.ay_mps2(acceleration_mps2.y());
  version.phase_count(static_cast<std::uint8_t>(version.phase_count() + 1));
}

Vec2 random_direction(Rng& rng) { return rotated({1, 0}, rng.uniform(0, 2 * std::numbers::pi)); }

/// Appends up to three phases of motion that are about as fast as the limits allow.
void add_motion(msg::Version& version, Rng& rng, const MotionLimits& limits) {
  for (std::uint64_t left = 1 + rng.below(3); left > 0; --left) {
    append(version, rng.uniform(0.05, 0.5),
           rng.uniform(0.3, 1.3) * limits.acceleration_mps2 * random_direction(rng));
  }
  brake(version, rng.uniform(0.85, 1.1) * limits.deceleration_mps2);
}

TEST_CASE("only versions beyond the limits are reported") {
  int beyond = 0, within = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    Scenario scenario = stage_scenario();
    scenario.field.length_m = scenario.field.width_m = 40;
    Stage stage(scenario);
    stage.begin();
    msg::Version version = stage.next(stage.rest(0), 1);
    add_motion(version, rng, scenario.limits);
    double max_speed = 0, max_effort = 0;
    each_sample(version, [&](const AuditPath::Node& n) {
      max_speed = std::max(max_speed, std::hypot(n.vx, n.vy));
      max_effort = std::max(max_effort, effort(n, scenario.limits));
    });
    const double excess = std::max(max_speed / scenario.limits.speed_mps, max_effort) - 1;
    stage.grant(version);
    if (std::abs(excess) < 0.003) continue;
    CAPTURE(excess, stage.lines());
    CHECK((stage.count(AuditRule::kLimits) > 0) == (excess > 0));
    CHECK(stage.count(AuditRule::kRest) == 0);
    CHECK(stage.count(AuditRule::kContinuity) == 0);
    ++(excess > 0 ? beyond : within);
  }
  CHECK(beyond > 50);
  CHECK(within > 50);
}

TEST_CASE("acceleration F, deceleration D and the speed limit are allowed, and slightly more is reported") {
  const double more = GENERATE(0.0, 0.0015, 0.0025);
  CAPTURE(more);
  Stage stage;
  stage.begin();
  const MotionLimits& limits = stage.scenario.limits;
  msg::Version version = stage.next(stage.rest(0), 1);
  SECTION("driving at F") {
    append(version, 0.2, {0, limits.acceleration_mps2 * (1 + more)});
    brake(version, 0.9 * limits.deceleration_mps2);
  }
  SECTION("braking at D") {
    append(version, 0.2, {0, 0.9 * limits.acceleration_mps2});
    brake(version, limits.deceleration_mps2 * (1 + more));
  }
  SECTION("driving at the speed limit") {
    const double speed_mps = limits.speed_mps + (more < 0.001 ? 8e-6 : 1.2e-5);
    append(version, speed_mps / limits.acceleration_mps2 / 0.9, {0.9 * limits.acceleration_mps2, 0});
    brake(version, 0.9 * limits.deceleration_mps2);
    stage.grant(version);
    CHECK(stage.count(AuditRule::kLimits) == (more < 0.001 ? 0 : 1));
    return;
  }
  stage.grant(version);
  INFO(stage.lines());
  CHECK(stage.count(AuditRule::kLimits) == (more > 0.002 ? 1 : 0));
}

TEST_CASE("a version that does not end at rest is reported") {
  const double speed_mps = GENERATE(0.0, 8e-6, 1.2e-5, 0.1);
  Stage stage;
  stage.begin();
  msg::Version version = stage.next(stage.rest(0), 1);
  append(version, 0.1, {0, speed_mps / 0.1});
  stage.grant(version);
  CHECK(stage.count(AuditRule::kRest) == (speed_mps > 1e-5 ? 1 : 0));
}

TEST_CASE("only versions that leave the field are reported") {
  int outside = 0, inside = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    Scenario scenario = stage_scenario();
    scenario.robots[0].start_m = {rng.uniform(-2.9, 2.9), rng.uniform(-1.9, 1.9)};
    Stage stage(scenario);
    stage.begin();
    msg::Version version = stage.next(stage.rest(0), 1);
    append(version, rng.uniform(0.1, 0.5), 3 * random_direction(rng));
    append(version, rng.uniform(0.1, 0.5), 3 * random_direction(rng));
    brake(version, 3);
    double most_m = -1;
    each_sample(version, [&](const AuditPath::Node& n) {
      most_m = std::max({most_m, std::abs(n.x) + 0.09 - 3, std::abs(n.y) + 0.09 - 2});
    });
    stage.grant(version);
    if (std::abs(most_m) < 1e-4) continue;
    CAPTURE(most_m, stage.lines());
    CHECK((stage.count(AuditRule::kField) > 0) == (most_m > 0));
    ++(most_m > 0 ? outside : inside);
  }
  CHECK(outside > 50);
  CHECK(inside > 50);
}

TEST_CASE("a robot outside the field may return in steps but not drive farther away") {
  const auto [to_m, is_reported] = GENERATE(table<double, bool>({{3.04, false}, {3.06, true}}));
  CAPTURE(to_m);
  Scenario scenario = stage_scenario();
  scenario.robots[0].start_m = {3.05, 0};
  Stage stage(scenario);
  stage.begin();
  msg::Version version = stage.next(stage.rest(0), 1);
  // Accelerates over half of the distance and brakes over the other half, half a second each.
  const double a_mps2 = (to_m - 3.05) / 0.25;
  append(version, 0.5, {a_mps2, 0});
  append(version, 0.5, {-a_mps2, 0});
  stage.grant(version);
  CHECK(stage.count(AuditRule::kField) == (is_reported ? 1 : 0));
  CHECK(stage.count(AuditRule::kRest) == 0);
}

/// The distance that the robot's centre must keep from edges.
double separation_m(const Scenario& scenario) { return scenario.radius_m + scenario.margin_m; }

TEST_CASE("a version that comes too near an obstacle is reported unless its base came equally near") {
  int near = 0, clear = 0, excused = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    Scenario scenario = stage_scenario();
    const Shape shape =
        rng.chance(0.5) ? Shape(Circle{{-1 + rng.uniform(-1, 1), rng.uniform(-1, 1)}, 0.1})
                        : Shape(Box{{-1.2, 0.1}, {-1.2 + rng.uniform(0.1, 1), 0.1 + rng.uniform(0.1, 1)}});
    scenario.obstacles.push_back(shape);
    Stage stage(scenario);
    stage.begin();
    msg::Version version = stage.next(stage.rest(0), 1);
    append(version, rng.uniform(0.1, 0.5), 3 * random_direction(rng));
    append(version, rng.uniform(0.1, 0.5), 3 * random_direction(rng));
    brake(version, 3);
    double nearest_m = 10;
    const auto distance_m = [&](double x, double y) { return std::max(0.0, signed_distance({x, y}, shape)); };
    each_sample(version,
                [&](const AuditPath::Node& n) { nearest_m = std::min(nearest_m, distance_m(n.x, n.y)); });
    const double at_rest_m = distance_m(version.x_m(), version.y_m());
    stage.grant(version);
    if (std::abs(nearest_m - separation_m(scenario)) < 1e-4) continue;
    const bool is_near = nearest_m < separation_m(scenario);
    const bool was_near = at_rest_m <= nearest_m + 1e-9;
    CAPTURE(nearest_m, at_rest_m, stage.lines());
    CHECK((stage.count(AuditRule::kObstacle) > 0) == (is_near && !was_near));
    ++(!is_near ? clear : was_near ? excused : near);
  }
  CHECK(near > 50);
  CHECK(clear > 50);
  CHECK(excused > 5);
}

TEST_CASE("a version keeps its inflation and the margin from obstacles but may use up its base's inflation") {
  // `closer_m`: distance by which the radius and the margin are violated.
  const auto [closer_m, inflation_m, is_reported] = GENERATE(table<double, double, bool>(
      {{-0.001, 0, false}, {0.001, 0, true}, {-0.021, 0.01, false}, {0.0001, 0.01, true}}));
  CAPTURE(closer_m, inflation_m);
  Scenario scenario = stage_scenario();
  scenario.obstacles.push_back(Circle{{-1, 1}, 0.2});
  Stage stage(scenario);
  stage.robot_reports[0].executing().inflation_m(inflation_m);
  stage.begin();
  msg::Version version = stage.next(stage.robot_reports[0].executing(), 1);
  version.inflation_m(inflation_m);
  const double way_m = 1 - 0.2 - separation_m(scenario) + closer_m;
  append(version, 1, {0, way_m});
  append(version, 1, {0, -way_m});
  stage.grant(version);
  INFO(stage.lines());
  CHECK(stage.count(AuditRule::kObstacle) == (is_reported ? 1 : 0));
}

TEST_CASE("an obstacle at the end of a fast straight path is found") {
  const double closer_m = GENERATE(-0.001, 0.001);
  Scenario scenario = stage_scenario();
  scenario.obstacles.push_back(Circle{{-1, 1.5}, 0.2});
  Stage stage(scenario);
  stage.begin();
  // Starts at full speed, so that the path is as long as possible, although that is not continuous.
  msg::Version version = stage.next(stage.rest(0), 1);
  version.vy_mps(1);
  append(version, 1.3 - separation_m(scenario) + closer_m - 0.125, {0, 0});
  brake(version, 4);
  stage.grant(version);
  CHECK(stage.count(AuditRule::kObstacle) == (closer_m > 0 ? 1 : 0));
}

TEST_CASE("a base of unknown content excuses nothing") {
  Scenario scenario = stage_scenario();
  scenario.obstacles.push_back(Circle{{0, 0}, 0.3});
  scenario.robots[0].start_m = {-0.41, 0};
  Stage stage(scenario);
  stage.begin();
  stage.decide(0, 1, 1);  // grants a version that was not proposed
  stage.violations.clear();
  msg::Version version = stage.next(stage.rest(0), 2);
  append(version, 1, {0.05, 0});
  append(version, 1, {-0.05, 0});
  version.base(1);
  stage.grant(version);
  CHECK(stage.count(AuditRule::kObstacle) == 1);
  CHECK(stage.count(AuditRule::kContinuity) == 0);
  CHECK(stage.count(AuditRule::kInflation) == 0);
}

TEST_CASE("blocked map cells are obstacles") {
  const double closer_m = GENERATE(-0.001, 0.001);
  Scenario scenario = stage_scenario();
  MapGrid grid;
  grid.columns = 80, grid.rows = 60, grid.resolution_m = 0.1, grid.origin_m = {-4, -3};
  BitGrid blocked(grid.columns, grid.rows);
  blocked.set(30, 40);  // from (-1, 1) to (-0.9, 1.1)
  scenario.map = std::make_shared<const FloorMap>(OccupancyMap(grid, blocked));
  Stage stage(scenario);
  stage.begin();
  msg::Version version = stage.next(stage.rest(0), 1);
  const double way_m = 1 - separation_m(scenario) + closer_m;
  append(version, 1, {0, way_m});
  append(version, 1, {0, -way_m});
  stage.grant(version);
  INFO(stage.lines());
  CHECK(stage.count(AuditRule::kObstacle) == (closer_m > 0 ? 1 : 0));
  // The second version begins where the first one ends and comes no nearer, so its base excuses it.
  stage.command(version);
  stage.advance(2500ms);
  stage.robot_reports[0].executing(version);
  stage.report(0);
  stage.drive(stage.next(version, 2));
  CHECK(stage.count(AuditRule::kObstacle) == (closer_m > 0 ? 1 : 0));
}

TEST_CASE("a version whose position or speed jumps from its base is reported") {
  const auto [by, is_reported] = GENERATE(table<double, bool>({{0, false}, {9e-8, false}, {1.1e-7, true}}));
  CAPTURE(by);
  const double sign = GENERATE(1.0, -1.0);
  Stage stage;
  stage.begin();
  msg::Version driving = stage.next(stage.rest(0), 1);
  append(driving, 0.5, {1, 2});
  brake(driving, 3);
  stage.drive(driving);
  REQUIRE(stage.violations.empty());
  stage.advance(200ms);
  msg::Version version = stage.next(driving, 2);
  brake(version, 3);
  SECTION("in x") { version.x_m(version.x_m() + sign * by); }
  SECTION("in y") { version.y_m(version.y_m() + sign * by); }
  SECTION("in the speed along x") { version.vx_mps(version.vx_mps() + sign * by); }
  SECTION("in the speed along y") { version.vy_mps(version.vy_mps() + sign * by); }
  stage.grant(version);
  INFO(stage.lines());
  CHECK(stage.count(AuditRule::kContinuity) == (is_reported ? 1 : 0));
  CHECK(stage.violations.size() == stage.count(AuditRule::kContinuity));
  if (is_reported)
    CHECK_THAT(stage.violations.front().detail, ContainsSubstring("0.250000 s after its base's start"));
}

TEST_CASE("a version that does not start after its base is reported") {
  const Duration after = GENERATE(-1ns, 0ns, 1ns);
  Stage stage;
  stage.begin();
  const msg::Version first = stage.next(stage.rest(0), 1, 100ms);
  stage.grant(first);
  stage.grant(stage.next(first, 2, 100ms + after));
  CHECK(stage.count(AuditRule::kContinuity) == (after > 0ns ? 0 : 1));
  CHECK(stage.violations.size() == stage.count(AuditRule::kContinuity));
}

TEST_CASE("a version must have the inflation of its base, or no inflation if it begins at rest") {
  Stage stage;
  stage.robot_reports[0].executing().inflation_m(0.01);
  stage.begin();
  const auto grant = [&](double inflation_m, double speed_mps) {
    msg::Version version = stage.next(stage.robot_reports[0].executing(), 1);
    version.inflation_m(inflation_m);
    version.vy_mps(speed_mps);
    brake(version, 3);
    stage.grant(version);
    return stage.count(AuditRule::kInflation);
  };
  SECTION("the same inflation") { CHECK(grant(0.01, 0) == 0); }
  SECTION("a different inflation") { CHECK(grant(0.009, 0) == 1); }
  SECTION("no inflation at rest") { CHECK(grant(0, 0) == 0); }
  SECTION("no inflation in motion") { CHECK(grant(0, 0.5) == 1); }
}

TEST_CASE("the base of a granted version must have been registered or granted in the epoch") {
  Stage stage;
  stage.begin();
  const msg::Version first = stage.next(stage.rest(0), 1);
  SECTION("the base was registered") { stage.grant(first); }
  SECTION("the base was granted") {
    stage.grant(first);
    stage.grant(stage.next(first, 2, 100ms));
  }
  SECTION("the base was only proposed") {
    stage.propose({first});
    stage.grant(stage.next(first, 2, 100ms));
    CHECK(stage.count(AuditRule::kBase) == 1);
    return;
  }
  SECTION("the base was granted in an earlier epoch and not registered") {
    stage.drive(first);
    ++stage.epoch;
    stage.robot_reports[0].obeyed_epoch(stage.epoch), stage.robot_reports[1].obeyed_epoch(stage.epoch);
    for (RobotId robot = 0; robot < 2; ++robot) stage.register_versions(robot, {stage.rest(robot)});
    stage.grant(stage.next(first, 2, 100ms));
    CHECK(stage.count(AuditRule::kBase) == 1);
    return;
  }
  SECTION("the base is the robot's own stop") {
    msg::Version stop = stage.next(stage.rest(0), 9, 0ms);
    stage.robot_reports[0].executing(stop);
    stage.robot_reports[0].is_off_reference(true);
    stage.report(0);
    stage.show_page({stop, stage.rest(1)});
    stage.grant(stage.next(stop, 10, 100ms));
  }
  INFO(stage.lines());
  CHECK(stage.violations.empty());
}

TEST_CASE("a version whose base does not have a lower number is reported") {
  const VersionNumber base = GENERATE(1u, 2u, 3u);
  Stage stage;
  stage.begin();
  msg::Version version = stage.next(stage.rest(0), 2);
  version.base(base);
  stage.grant(version);
  CHECK(stage.count(AuditRule::kVersionOrder) == (base < 2 ? 0 : 1));
}

}  // namespace sidestep::auditor_content_test
