// SPDX-License-Identifier: Apache-2.0
// Robots that lose power while they drive, and robots without power that
// a person carries among the others.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "common/random/rng.hpp"
#include "deploy/audit/metrics/report.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "simulator/world/body.hpp"
#include "tests/catch.hpp"
#include "tests/sim/disturbance.hpp"

namespace sidestep::displaced_test {

constexpr double kStep_s = 0.001;
constexpr Duration kDetectionTime = std::chrono::milliseconds(150);

Vec2 random_place(Rng& rng, const Field& field, const std::vector<Vec2>& taken, double min_distance_m) {
  for (;;) {
    const double x = field.length_m / 2 - 0.3, y = field.width_m / 2 - 0.3;
    const Vec2 place(rng.uniform(-x, x), rng.uniform(-y, y));
    if (std::ranges::all_of(taken, [&](const Vec2& t) { return (t - place).norm() >= min_distance_m; }))
      return place;
  }
}

/// Robots that drive back and forth, so that they are in motion whenever a fault occurs.
Scenario random_floor(std::uint64_t seed) {
  Rng rng(seed);
  Scenario scenario;
  scenario.name = "displaced";
  scenario.field = {rng.uniform(5, 9), rng.uniform(4, 6)};
  const std::uint64_t robots = 5 + rng.below(6);
  std::vector<Vec2> starts;
  std::vector<std::vector<Vec2>> goals(5);
  for (std::uint64_t i = 0; i < robots; ++i) {
    RobotSpec robot;
    robot.id = static_cast<RobotId>(i);
    robot.start_m = random_place(rng, scenario.field, starts, 0.4);
    starts.push_back(robot.start_m);
    for (std::vector<Vec2>& taken : goals) {
      taken.push_back(random_place(rng, scenario.field, taken, 0.4));
      robot.goals.push_back({taken.back(), std::nullopt});
    }
    scenario.robots.push_back(robot);
  }
  return scenario;
}

/// The ground truth at one time.
struct Moment {
  Time at;
  std::map<RobotId, State> robots;
};

Moment moment_of(const msg::GroundTruth& truth) {
  Moment moment{time_from_ns(truth.valid_at_ns()), {}};
  for (const msg::TrueRobotState& robot : truth.robots())
    moment.robots[robot.robot()] = {{robot.x_m(), robot.y_m()}, {robot.vx_mps(), robot.vy_mps()}};
  return moment;
}

/// The straight path of an uncontrolled body, parametrised by distance.
struct BodyPath {
  Vec2 from_m, direction;
  double speed_mps, deceleration_mps2;
  double end_s;  ///< time at which the body comes to rest

  static BodyPath coasting(const State& state) {
    const double speed = state.velocity_mps.norm();
    const double deceleration = Body::kRolling_mps2;
    return {state.position_m, state.velocity_mps / speed, speed, deceleration, speed / deceleration};
  }
  static BodyPath carried(const Vec2& from, const Vec2& to, double seconds) {
    return {from, (to - from).normalized(), (to - from).norm() / seconds, 0, seconds};
  }
  Vec2 position_m(double t_s) const {
    const double t = std::clamp(t_s, 0.0, end_s);
    return from_m + (speed_mps * t - 0.5 * deceleration_mps2 * t * t) * direction;
  }
};

/// Whether a robot stays clear of the body if it moves as in `undisturbed` for the detection time and then
/// brakes. Half the margin covers its tracking error.
bool can_stop_without_contact(RobotId robot, const std::vector<Moment>& undisturbed, const BodyPath& body,
                              Time fault, const Scenario& scenario) {
  const auto is_clear = [&](const Vec2& position, double t_s) {
    return (position - body.position_m(t_s)).norm() > 2 * scenario.radius_m + scenario.margin_m / 2;
  };
  State last;
  double last_s = 0;
  for (const Moment& moment : undisturbed) {
    if (moment.at < fault || moment.at > fault + kDetectionTime) continue;
    last = moment.robots.at(robot);
    last_s = to_seconds(moment.at - fault);
    if (!is_clear(last.position_m, last_s)) return false;
  }
  // The robot keeps its last speed until the detection time has passed, and then brakes.
  const double speed = last.velocity_mps.norm();
  const Vec2 direction = speed > 0 ? Vec2(last.velocity_mps / speed) : Vec2(0, 0);
  const double brakes_at_s = to_seconds(kDetectionTime);
  const double stops_at_s = brakes_at_s + speed / scenario.limits.deceleration_mps2;
  for (double t = last_s; t < std::max(stops_at_s, body.end_s) + kStep_s; t += kStep_s) {
    const double braking_s = std::clamp(t, brakes_at_s, stops_at_s) - brakes_at_s;
    const double driven = speed * (std::min(t, brakes_at_s) - last_s) + speed * braking_s -
                          0.5 * scenario.limits.deceleration_mps2 * braking_s * braking_s;
    if (!is_clear(last.position_m + driven * direction, t)) return false;
  }
  return true;
}

struct Fault {
  RobotId robot = 0;
  Time switched_off{};
  Time moved{};  ///< when the body begins its uncontrolled motion
  bool is_carried = false;
  Vec2 target_m{0, 0};
  Duration duration{0};
};

/// One run, with or without the body's uncontrolled motion.
struct Run {
  Run(const Scenario& scenario, std::uint64_t seed) : system(scenario, seed), observer(system.network()) {
    system.observer_bus().subscribe(topics::kTruth, [this](const msg::GroundTruth& truth) {
      truths.push_back(moment_of(truth));
      for (; contacts < truth.contacts(); ++contacts)
        touches.push_back({truth.recent_contacts()[contacts % msg::MAX_CONTACTS], truths.size() - 1});
    });
    observer.subscribe(topics::kCoordinator, [this](const msg::CoordinatorState& state) {
      for (const msg::RobotNotice& notice : state.notices()) {
        if (notice.is_displaced()) named.emplace(notice.robot(), system.now());
      }
    });
  }

  SimSystem system;
  SimBus observer;
  std::vector<Moment> truths;
  struct Touch {
    msg::ContactPair pair;
    std::size_t moment;  ///< index of the first ground truth that shows the motion
  };
  std::vector<Touch> touches;
  std::uint64_t contacts = 0;
  std::map<RobotId, Time> named;  ///< time at which each robot was first named as displaced
};

struct Totals {
  int cases = 0;
  int judged = 0;             ///< number of robots that could stop without touching the body
  int touched = 0;            ///< number of judged robots that touched it
  int other_contacts = 0;     ///< number of contacts between two robots that were not displaced
  int unnamed = 0;            ///< number of bodies not named within a second
  int falsely_displaced = 0;  ///< number of robots named before the fault
  Duration slowest_detection{0};
};

/// Chooses the fault in an undisturbed run. The run ends when the body begins to move.
Fault choose_fault(Run& run, const Scenario& scenario, Rng& rng, bool is_carried) {
  Fault fault;
  fault.is_carried = is_carried;
  run.system.run_for(from_seconds(rng.uniform(1, 3)));
  const auto speed_of = [](const auto& robot) { return robot.second.velocity_mps.norm(); };
  if (!is_carried) {
    for (;;) {
      const auto& robots = run.truths.back().robots;
      const auto fastest = std::ranges::max_element(robots, {}, speed_of);
      if (speed_of(*fastest) > 0.5) {
        fault.robot = fastest->first;
        break;
      }
      run.system.run_for(std::chrono::milliseconds(50));
    }
    fault.switched_off = fault.moved = run.system.now();
    return fault;
  }
  // A body that is about to roll off the field would leave the cameras' view.
  const auto stays = [&](const State& state) {
    const Vec2 rolls_to = state.position_m + 1.0 * state.velocity_mps * state.velocity_mps.norm();
    return std::abs(rolls_to.x()) < scenario.field.length_m / 2 &&
           std::abs(rolls_to.y()) < scenario.field.width_m / 2;
  };
  do {
    run.system.run_for(std::chrono::milliseconds(20));
    fault.robot = scenario.robots[rng.below(scenario.robots.size())].id;
  } while (!stays(run.truths.back().robots.at(fault.robot)));
  fault.switched_off = run.system.now();
  auto off = disturbance(fault.robot, msg::DisturbanceKind::DISTURBANCE_SWITCH_OFF);
  run.system.disturb(off);
  run.system.run_for(from_seconds(rng.uniform(3, 5)));
  fault.moved = run.system.now();
  fault.target_m =
      random_place(rng, scenario.field, {run.truths.back().robots.at(fault.robot).position_m}, 1);
  const double path_m = (fault.target_m - run.truths.back().robots.at(fault.robot).position_m).norm();
  fault.duration = from_seconds(path_m / rng.uniform(0.3, 1.2));
  return fault;
}

void count_touches(const Run& run, std::size_t first, const Fault& fault, const std::set<RobotId>& judged,
                   std::uint64_t seed, Totals& totals) {
  bool is_on_path = true;
  std::set<RobotId> displaced{fault.robot};  // including those that it has pushed
  for (std::size_t i = first; i < run.touches.size(); ++i) {
    const Run::Touch& touch = run.touches[i];
    const RobotId low = std::min(touch.pair.first(), touch.pair.second());
    const RobotId high = std::max(touch.pair.first(), touch.pair.second());
    const Moment& before = run.truths[touch.moment - 1];
    const bool is_with_body = low == fault.robot || high == fault.robot;
    const bool is_judged = is_with_body && judged.contains(low == fault.robot ? high : low);
    const bool is_of_others = !displaced.contains(low) && !displaced.contains(high);
    if (!is_of_others) displaced.insert({low, high});
    totals.other_contacts += is_of_others;
    if (is_judged && is_on_path) ++totals.touched;
    if (is_of_others || (is_judged && is_on_path)) {
      WARN("seed " << seed << ": robots " << low << " at " << before.robots.at(low).velocity_mps.norm()
                   << " m/s and " << high << " at " << before.robots.at(high).velocity_mps.norm()
                   << " m/s touch " << to_seconds(before.at - fault.moved) << " s after robot " << fault.robot
                   << (fault.is_carried ? " was carried" : " lost power"));
    }
    // A body that hits a robot leaves its predicted path, so the other robots cannot be judged.
    if (is_with_body && !is_judged) is_on_path = false;
  }
}

void run_case(std::uint64_t seed, bool is_carried, Totals& totals) {
  const Scenario scenario = random_floor(seed);
  Rng rng(seed + 1'000'000);
  Run undisturbed(scenario, seed);
  const Fault fault = choose_fault(undisturbed, scenario, rng, is_carried);
  const State body = undisturbed.truths.back().robots.at(fault.robot);
  undisturbed.system.run_for(kDetectionTime + std::chrono::milliseconds(20));
  const BodyPath path = is_carried
                            ? BodyPath::carried(body.position_m, fault.target_m, to_seconds(fault.duration))
                            : BodyPath::coasting(body);

  Run run(scenario, seed);
  run.system.run_until(fault.switched_off);
  const std::size_t named_before = run.named.size();
  auto off = disturbance(fault.robot, msg::DisturbanceKind::DISTURBANCE_SWITCH_OFF);
  run.system.disturb(off);
  if (is_carried) {
    run.system.run_until(fault.moved);
    run.named.erase(fault.robot);  // this robot counted as displaced because it coasted
    auto carry = disturbance(fault.robot, msg::DisturbanceKind::DISTURBANCE_CARRY);
    carry.x_m(fault.target_m.x());
    carry.y_m(fault.target_m.y());
    carry.duration_ns(fault.duration.count());
    run.system.disturb(carry);
  }
  const std::size_t touches_before = run.touches.size();
  run.system.run_until(fault.moved + from_seconds(path.end_s + 1));

  ++totals.cases;
  totals.falsely_displaced += static_cast<int>(named_before);
  const auto named = run.named.find(fault.robot);
  if (named == run.named.end() || named->second - fault.moved > std::chrono::seconds(1))
    ++totals.unnamed;
  else
    totals.slowest_detection = std::max(totals.slowest_detection, named->second - fault.moved);
  std::set<RobotId> judged;
  for (const RobotSpec& robot : scenario.robots) {
    if (robot.id != fault.robot &&
        can_stop_without_contact(robot.id, undisturbed.truths, path, fault.moved, scenario))
      judged.insert(robot.id);
  }
  totals.judged += static_cast<int>(judged.size());
  count_touches(run, touches_before, fault, judged, seed, totals);
}

Totals run_cases(std::uint64_t first, std::uint64_t count) {
  Totals totals;
  for (std::uint64_t seed = first; seed < first + count; ++seed) run_case(seed, seed % 2 == 0, totals);
  WARN(totals.cases << " cases: " << totals.judged << " robots could stop clear, " << totals.touched
                    << " of them touched; " << totals.other_contacts << " other contacts; " << totals.unnamed
                    << " not named within 1 s, slowest " << to_seconds(totals.slowest_detection) << " s; "
                    << totals.falsely_displaced << " named without a fault");
  return totals;
}

void check(const Totals& totals) {
  CHECK(totals.judged > totals.cases);
  CHECK(totals.touched == 0);
  CHECK(totals.other_contacts == 0);
  CHECK(totals.unnamed == 0);
  CHECK(totals.falsely_displaced == 0);
}

TEST_CASE(
    "robots stay clear of robots that coast without power or are carried, which the coordinator reports as "
    "displaced") {
  check(run_cases(1, 40));
}

// Seeds 1 to 1000 are not used, because the agents' handling of displaced robots was tuned on them.
TEST_CASE("a thousand coasting and carried robots are reported as displaced, and no robot drives into them",
          "[.long][slow]") {
  check(run_cases(1001, 1000));
}

// Robot 1 loses power and is carried to where robot 0 is about to drive. By the coordinator's clock,
// observations may be dated in the future.
TEST_CASE("a carried robot is reported as displaced or no robot drives, for all clocks within their bound") {
  Scenario scenario;
  scenario.name = "lax clocks";
  scenario.field = {6, 4};
  scenario.limits.speed_mps = 0.2;
  scenario.clock_bound_s = 0.05;
  scenario.margin_m = 0.05;
  scenario.vision.delay = std::chrono::milliseconds(GENERATE(10, 60));
  scenario.robots.resize(2);
  scenario.robots[0].start_m = {-2.5, 0};
  scenario.robots[0].goals = {{Vec2(2.5, 0), std::nullopt}, {Vec2(-2.5, 0), std::nullopt}};
  scenario.robots[1].id = 1;
  scenario.robots[1].start_m = {0, 1.5};
  const Duration ahead = std::chrono::milliseconds(GENERATE(0, -20, -45, 45, -250));
  const bool is_in_bound = std::chrono::abs(ahead) <= from_seconds(scenario.clock_bound_s);
  CAPTURE(to_seconds(scenario.vision.delay), to_seconds(ahead));
  SimSystem system(scenario, 1, {{"coordinator", {ahead}}});
  SimBus listener(system.network());
  listener.become_observer();
  bool is_named = false, moves = false;
  listener.subscribe(topics::kCoordinator, [&](const msg::CoordinatorState& state) {
    for (const msg::RobotNotice& notice : state.notices())
      is_named |= notice.robot() == 1 && notice.is_displaced();
  });
  system.observer_bus().subscribe(topics::kTruth, [&](const msg::GroundTruth& truth) {
    for (const msg::TrueRobotState& robot : truth.robots())
      moves |= robot.robot() == 0 && std::hypot(robot.vx_mps(), robot.vy_mps()) > 0.1;
  });
  system.run_for(std::chrono::seconds(3));
  auto off = disturbance(1, msg::DisturbanceKind::DISTURBANCE_SWITCH_OFF);
  system.disturb(off);
  system.run_for(std::chrono::milliseconds(100));
  auto carry = disturbance(1, msg::DisturbanceKind::DISTURBANCE_CARRY);
  carry.x_m(0.8);
  carry.duration_ns(1'000'000'000);
  system.disturb(carry);
  system.run_for(std::chrono::seconds(30));
  CHECK(system.metrics().report().contacts == 0);
  CHECK(moves == is_in_bound);
  CHECK(is_named == is_in_bound);
}

TEST_CASE(
    "a robot that is carried elsewhere and switched on drives again, and no longer counts as displaced") {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    CAPTURE(seed);
    Scenario scenario = random_floor(seed);
    for (RobotSpec& robot : scenario.robots) robot.goals.resize(2);
    Run run(scenario, seed);
    run.system.run_for(std::chrono::seconds(1));
    auto off = disturbance(0, msg::DisturbanceKind::DISTURBANCE_SWITCH_OFF);
    run.system.disturb(off);
    run.system.run_for(std::chrono::seconds(4));
    auto carry = disturbance(0, msg::DisturbanceKind::DISTURBANCE_CARRY);
    carry.x_m(0.2);
    carry.y_m(0.1);
    carry.duration_ns(2'000'000'000);
    run.system.disturb(carry);
    run.system.run_for(std::chrono::seconds(3));
    CHECK(run.named.contains(0));
    auto on = disturbance(0, msg::DisturbanceKind::DISTURBANCE_SWITCH_ON);
    run.system.disturb(on);
    CHECK(run.system.run_until_arrived(run.system.now() + std::chrono::seconds(60)));
    run.named.clear();
    run.system.run_for(std::chrono::milliseconds(100));
    CHECK(run.named.empty());
  }
}

}  // namespace sidestep::displaced_test
