// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/conformance/version_stream.hpp"

#include <algorithm>

#include "common/motion/robot_model.hpp"
#include "common/motion/validity.hpp"

namespace sidestep {
namespace {

constexpr int kHeldCycles = 3;
// Reports show a version within this time after its start.
constexpr Duration kReportTimeout = std::chrono::milliseconds(200);

}  // namespace

VersionStream::VersionStream(RobotProbe& probe, const Scenario& scenario)
    : probe_(probe), limits_(scenario.limits), field_(scenario.field), radius_m_(scenario.radius_m) {}

Duration VersionStream::notice() const {
  return (probe_.robot_report() ? probe_.robot_report()->lead : Duration{0}) + 3 * probe_.cycle();
}

Version VersionStream::next(const Trajectory& trajectory) {
  const Version& executing = probe_.robot_report()->executing;
  number_ = std::max({number_, executing.number, probe_.incarnation}) + 1;
  Version version;
  version.robot = probe_.robot();
  version.incarnation = probe_.incarnation;
  version.number = number_;
  version.base = last_ ? last_->number : executing.number;
  version.trajectory = trajectory;
  const Version& base = last_ ? *last_ : executing;
  version.inflation_m = trajectory.at_start().velocity_mps.norm() <= 1e-6 ? 0 : base.inflation_m;
  return version;
}

void VersionStream::resynchronise() {
  if (!last_) return;
  const RobotReport& robot_report = *probe_.robot_report();
  const bool is_late = robot_report.valid_at > last_->trajectory.start() + kReportTimeout &&
                       robot_report.executing.number != last_->number;
  // The robot's own stop replaces all versions.
  const bool is_own_stop = robot_report.is_off_reference && robot_report.executing.number > last_->number;
  if (!is_late && !is_own_stop) return;
  ++(is_own_stop ? own_stops_ : late_versions_);
  last_.reset();
}

void VersionStream::extend(const Policy& policy) {
  if (!probe_.robot_report()) return;
  resynchronise();
  const Time robot_now = probe_.robot_now();
  const Version base = last_ ? *last_ : probe_.robot_report()->executing;
  const Duration held = kHeldCycles * probe_.cycle();
  Time start = base.trajectory.start() + held;
  if (start - robot_now >= notice() + probe_.cycle()) return;
  if (start - robot_now < notice()) start = robot_now + notice();
  const State from = base.trajectory.state_at(start);
  Vec2 acceleration = limit_acceleration(policy(from, start), from.velocity_mps, limits_, held);
  for (int attempt = 0;; ++attempt) {
    Trajectory trajectory(start, from);
    trajectory.append(held, acceleration);
    append_stop(trajectory, limits_.deceleration_mps2);
    if (stays_on(field_, radius_m_, trajectory) && check_limits(trajectory, limits_) == Validity::kValid) {
      last_ = next(trajectory);
      probe_.version = last_;
      return;
    }
    if (attempt == 4) return;  // the robot stops
    acceleration = attempt == 3 ? Vec2(0, 0) : Vec2(0.5 * acceleration);
  }
}

void VersionStream::stop() { probe_.version.reset(); }

void VersionStream::forget() {
  stop();
  last_.reset();
}

bool VersionStream::is_at_rest() const {
  if (!probe_.robot_report()) return false;
  const Version& executing = probe_.robot_report()->executing;
  const bool is_last = !last_ || executing.number >= last_->number;
  return is_last && executing.trajectory.end() < probe_.robot_report()->valid_at;
}

}  // namespace sidestep
