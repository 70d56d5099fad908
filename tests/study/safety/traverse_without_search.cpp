// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include "agents/navigation/motion_control.hpp"
#include "agents/safety/safety_search.hpp"
#include "simulator/world/firmware.hpp"
#include "tests/study/safety/traversal.hpp"

namespace sidestep {
namespace {

constexpr Time kBegin = time_from_ns(1'000'000'000'000);
constexpr double kGoalTolerance_m = 0.001;

/// A robot that executes its desired acceleration unchecked.
class UncoordinatedRobot {
 public:
  UncoordinatedRobot(const RobotSpec& spec, const Scenario& scenario)
      : spec_(spec),
        scenario_(scenario),
        body_(spec.start_m, 0, {}),
        firmware_(spec.id, spec.start_m, 0, kBegin, {}),
        last_m_(spec.start_m) {}

  void step(Time now) {
    body_.step(actuation_);
    const Odometry odometry{(body_.position_m() - last_m_) / kPhysicsStepSeconds, body_.angular_radps()};
    last_m_ = body_.position_m();
    actuation_ = firmware_.tick(now, odometry);
    const Vec2 reference = firmware_.executing().trajectory.state_at(now).position_m;
    reference_error_m_ = std::max(reference_error_m_, (reference - last_m_).norm());
  }

  /// Commands the desired acceleration for the next cycle, which begins at `start`.
  void decide(Time now, Time start) {
    const Version& base = firmware_.executing();
    const Vec2 rest = base.trajectory.rest_position_m();
    if (now >= base.trajectory.end() && (rest - goal()).norm() < scenario_.goal_tolerance_m) ++traversals_;
    if ((rest - goal()).norm() < kGoalTolerance_m) return;
    const State there = base.trajectory.state_at(start);
    const AccelerationCommand desired = desired_acceleration(
        goal() - there.position_m, there.velocity_mps, scenario_.limits, scenario_.cycle, scenario_.cycle);
    const Trajectory trajectory = accelerate_then_stop(start, there, desired.acceleration_mps2, desired.hold,
                                                       scenario_.limits.deceleration_mps2);
    Command command;
    command.robot = spec_.id;
    command.incarnation = 1;
    command.epoch = 1;
    command.version = {spec_.id, 1, base.number + 1, base.number, trajectory};
    firmware_.on_command(command, now);
  }

  const Vec2& position_m() const { return body_.position_m(); }
  std::uint64_t traversals() const { return traversals_; }
  double reference_error_m() const { return reference_error_m_; }

 private:
  const Vec2& goal() const { return spec_.goals[traversals_ % spec_.goals.size()].position_m; }

  const RobotSpec& spec_;
  const Scenario& scenario_;
  Body body_;
  Firmware firmware_;
  Actuation actuation_;
  Vec2 last_m_;
  std::uint64_t traversals_ = 0;
  double reference_error_m_ = 0;
};

}  // namespace

TraversalResult traverse_without_search(const Scenario& scenario, double seconds) {
  std::vector<UncoordinatedRobot> robots;
  robots.reserve(scenario.robots.size());
  for (const RobotSpec& spec : scenario.robots) robots.emplace_back(spec, scenario);
  Interpenetration meter(robots.size(), kStudyRadius_m);
  std::vector<Vec2> positions_m(robots.size());
  Time next_cycle = kBegin;
  for (Time now = kBegin; now < kBegin + from_seconds(seconds); now += kPhysicsStep) {
    for (UncoordinatedRobot& robot : robots) robot.step(now);
    if (now >= next_cycle) {
      next_cycle += scenario.cycle;
      for (UncoordinatedRobot& robot : robots) robot.decide(now, next_cycle);
    }
    std::ranges::transform(robots, positions_m.begin(), &UncoordinatedRobot::position_m);
    meter.add(positions_m, kPhysicsStepSeconds);
  }
  TraversalResult result = result_of(meter);
  for (const UncoordinatedRobot& robot : robots) {
    result.traversals += robot.traversals();
    result.reference_error_m = std::max(result.reference_error_m, robot.reference_error_m());
  }
  return result;
}

}  // namespace sidestep
