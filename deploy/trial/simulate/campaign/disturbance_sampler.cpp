// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/disturbance_sampler.hpp"

#include <algorithm>
#include <iterator>
#include <numbers>
#include <set>

#include "deploy/trial/simulate/campaign/position_sampler.hpp"

namespace sidestep {
namespace {

using Kind = msg::DisturbanceKind;

constexpr std::size_t kPlaces = 8;

class DisturbanceSampler {
 public:
  DisturbanceSampler(const Scenario& scenario, const FaultTimes& times, FaultPlan& plan, Rng& rng)
      : scenario_(scenario), times_(times), plan_(plan), rng_(rng), positions_(scenario, rng) {}

  void sample() {
    if (rng_.chance(0.12)) repeat(8, [&] { sample_body(); });
    if (rng_.chance(0.14)) repeat(3, [&] { sample_lift(); });
    if (rng_.chance(0.14)) repeat(2, [&] { sample_power_loss(); });
    if (rng_.chance(0.08)) repeat(2, [&] { sample_carry(); });
    if (rng_.chance(0.12)) repeat(4, [&] { sample_clock_step(); });
    if (rng_.chance(0.15)) repeat(3, [&] { sample_vision_fault(); });
    if (rng_.chance(0.12)) repeat(3, [&] { sample_lost_pose(); });
  }

 private:
  template <typename Do>
  void repeat(std::uint64_t max_count, Do sample_one) {
    for (std::uint64_t left = 1 + rng_.below(max_count); left > 0; --left) sample_one();
  }
  double log_uniform(double low, double high) { return sample_log_uniform(low, high, rng_); }
  double angle_rad() { return rng_.uniform(-std::numbers::pi, std::numbers::pi); }
  RobotId random_robot() { return scenario_.robots[rng_.below(scenario_.robots.size())].id; }
  void add(Duration at, RobotId robot, Kind kind) {
    RobotDisturbance disturbance;
    disturbance.robot = robot;
    disturbance.kind = kind;
    plan_.add(at, disturbance);
  }

  void sample_body() {
    static constexpr Kind kKinds[] = {Kind::DISTURBANCE_PUSH, Kind::DISTURBANCE_SLIP, Kind::DISTURBANCE_BLOCK,
                                      Kind::DISTURBANCE_REBOOT};
    RobotDisturbance disturbance;
    disturbance.robot = random_robot();
    disturbance.kind = kKinds[rng_.below(std::size(kKinds))];
    const Duration at = times_.sample(rng_);
    const double push_angle_rad = angle_rad();
    disturbance.push_mps = rotated(Vec2(log_uniform(0.05, 2), 0), push_angle_rad);
    disturbance.grip = rng_.uniform(0.05, 0.9);
    disturbance.heading_rad = angle_rad();
    disturbance.duration = times_.until_healed(at, log_uniform(0.05, 3));
    plan_.add(at, disturbance);
  }

  /// The operator lifts a robot and usually puts it down at any free place, among driving robots.
  void sample_lift() {
    const RobotId robot = random_robot();
    if (plan_.ends.contains(robot) || !handled_.insert(robot).second) return;
    const Duration at = times_.sample(rng_);
    add(at, robot, Kind::DISTURBANCE_LIFT);
    if (rng_.chance(0.2)) {
      plan_.ends[robot] = RobotEnd::kLifted;
      return;
    }
    Place place{robot, {}, angle_rad()};
    while (place.places_m.size() < kPlaces) place.places_m.push_back(positions_.sample());
    const Duration ready = rng_.chance(0.3) ? sample_restart_in_hand(robot, at) : at;
    plan_.add(times_.after(ready, log_uniform(0.05, 10)), std::move(place));
  }

  /// A person changes the battery of a lifted robot. Returns when the robot is switched on again.
  Duration sample_restart_in_hand(RobotId robot, Duration lifted_at) {
    const Duration off = times_.after(lifted_at, log_uniform(0.02, 1));
    const Duration on = times_.after(off, log_uniform(0.02, 4));
    add(off, robot, Kind::DISTURBANCE_SWITCH_OFF);
    add(on, robot, Kind::DISTURBANCE_SWITCH_ON);
    return on;
  }

  /// A robot loses power for a moment, or longer; then a person carries it away or takes it off the floor.
  void sample_power_loss() {
    const RobotId robot = random_robot();
    if (!handled_.insert(robot).second) return;
    Duration at = times_.sample(rng_);
    add(at, robot, Kind::DISTURBANCE_SWITCH_OFF);
    if (rng_.chance(0.4)) {
      at = times_.after(at, rng_.uniform(0.5, 4));
      plan_.add(at, carry_of(robot));
    }
    const Duration end = times_.after(at, log_uniform(0.05, 8));
    if (rng_.chance(0.3) && !plan_.ends.contains(robot)) {
      plan_.ends[robot] = RobotEnd::kTakenAway;
      plan_.add(end, TakeAway{robot});
    } else {
      add(end, robot, Kind::DISTURBANCE_SWITCH_ON);
    }
  }

  void sample_carry() {
    const RobotId robot = random_robot();
    plan_.add(times_.sample(rng_), carry_of(robot));
  }
  void sample_vision_fault() {
    static constexpr Kind kKinds[] = {Kind::DISTURBANCE_SEEN_BESIDE, Kind::DISTURBANCE_SEEN_AS,
                                      Kind::DISTURBANCE_SEEN_FROZEN};
    RobotDisturbance disturbance;
    disturbance.robot = random_robot();
    disturbance.kind = kKinds[rng_.below(std::size(kKinds))];
    const double angle = angle_rad();
    disturbance.place_m = rotated(Vec2(log_uniform(0.0005, 0.5), 0), angle);
    disturbance.other_robot = random_robot();
    const Duration at = times_.sample(rng_);
    disturbance.duration = times_.until_healed(at, log_uniform(0.03, 4));
    const bool is_confused = disturbance.kind == Kind::DISTURBANCE_SEEN_AS;
    if (!is_confused || disturbance.other_robot != disturbance.robot) plan_.add(at, disturbance);
  }
  void sample_lost_pose() {
    const RobotId robot = random_robot();
    if (plan_.ends.contains(robot) || !handled_.insert(robot).second) return;
    add(times_.sample(rng_), robot, Kind::DISTURBANCE_FORGET_POSE);
  }
  /// The clock jumps, and is usually set right later.
  void sample_clock_step() {
    const RobotSpec& robot = scenario_.robots[rng_.below(scenario_.robots.size())];
    if (plan_.ends.contains(robot.id) || !handled_.insert(robot.id).second) return;
    const Duration at = times_.sample(rng_);
    const double size_s = rng_.chance(0.6) ? log_uniform(0.0006, 0.03) : log_uniform(0.03, 900);
    const Duration error = from_seconds(rng_.chance(0.5) ? size_s : -size_s);
    add_clock(at, robot, error);
    const Duration right_at =
        std::min(times_.after(at, log_uniform(0.05, 15)), plan_.healed_at - Duration{1});
    if (rng_.chance(0.75) && right_at > at)
      add_clock(right_at, robot, Duration{0});
    else
      plan_.ends[robot.id] = final_clock_state(error, scenario_);
  }
  void add_clock(Duration at, const RobotSpec& robot, Duration error) {
    RobotDisturbance disturbance;
    disturbance.robot = robot.id;
    disturbance.kind = Kind::DISTURBANCE_CLOCK;
    disturbance.clock_offset = robot.clock_offset + error;
    plan_.add(at, disturbance);
  }
  Carry carry_of(RobotId robot) {
    const double speed_mps = rng_.uniform(0.3, 1.5);
    return {robot, positions_.sample(), speed_mps};
  }

  const Scenario& scenario_;
  const FaultTimes& times_;
  FaultPlan& plan_;
  Rng& rng_;
  PositionSampler positions_;
  std::set<RobotId> handled_;  // robots that are lifted, without power, with a wrong clock or without a pose;
                               // each at most once
};

}  // namespace

void sample_disturbances(const Scenario& scenario, const FaultTimes& times, FaultPlan& plan, Rng& rng) {
  DisturbanceSampler(scenario, times, plan, rng).sample();
}

}  // namespace sidestep
