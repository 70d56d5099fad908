// SPDX-License-Identifier: Apache-2.0
#include "simulator/world/firmware_monitor.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

constexpr double kMaxInflation_m = 1;
constexpr double kDurationResolution_s = 1e-9;

}  // namespace

void FirmwareMonitor::command_arrived(const Command& command, Time now) {
  highest_seen_ = std::max(highest_seen_, command.incarnation);
  if (!command.version) return;
  const Version& version = *command.version;
  highest_seen_ = std::max(highest_seen_, version.number);
  const bool is_old_epoch = command.epoch < acknowledged_epoch_;
  if (is_old_epoch || version.trajectory.start() <= now) return;
  const Arrival arrival{version.number, version.base, version.incarnation, version.trajectory.start()};
  if (arrival.number <= highest_arrived_ && arrived_in_time(arrival)) return;
  highest_arrived_ = std::max(highest_arrived_, arrival.number);
  arrivals_[static_cast<std::size_t>(arrival_count_++ % arrivals_.size())] = arrival;
}

bool FirmwareMonitor::arrived_in_time(const Arrival& wanted) const {
  // Searches backwards, because the latest arrival matches in almost all cases.
  for (std::uint64_t back = 1; back <= std::min<std::uint64_t>(arrival_count_, arrivals_.size()); ++back) {
    if (arrivals_[static_cast<std::size_t>((arrival_count_ - back) % arrivals_.size())] == wanted)
      return true;
  }
  return false;
}

void FirmwareMonitor::switched(const Version& to) {
  check_rule(!expects_clock_stop_);
  check_rule(to.base == executing_.number);
  check_rule(to.number > highest_executed_);
  check_rule(arrived_in_time({to.number, to.base, to.incarnation, to.trajectory.start()}));
  check_rule(to.incarnation >= executing_.incarnation && to.incarnation >= acknowledged_);
  check_rule(to.trajectory.start() > last_report_);
  const State& begin = to.trajectory.at_start();
  if (is_lifted_) {
    // A lifted robot may switch only to a rest version, at the place where it will be put down.
    check_rule(executing_.number == 0 && to.trajectory.phases().empty() && begin.velocity_mps.norm() == 0);
  } else {
    const State previous = executing_.trajectory.state_at(to.trajectory.start());
    check_rule((begin.position_m - previous.position_m).norm() <= kMaxPositionJump_m &&
               (begin.velocity_mps - previous.velocity_mps).norm() <= kMaxVelocityJump_mps);
  }
  executing_ = to;
  highest_executed_ = to.number;
  is_own_ = false;
}

bool FirmwareMonitor::is_own_stop(const Trajectory& stop) const {
  const Vec2& velocity = stop.at_start().velocity_mps;
  const double braking_s = velocity.norm() / deceleration_mps2_;
  if (stop.phases().empty()) return braking_s <= kDurationResolution_s;
  if (stop.phases().size() > 1) return false;
  const Vec2& braking = stop.phases()[0].acceleration_mps2;
  // Phases last a whole number of nanoseconds, so the deceleration may differ slightly.
  const double tolerance = 1e-3 + kDurationResolution_s / braking_s;
  return std::abs(cross(velocity, braking)) <= 1e-9 * velocity.norm() && velocity.dot(braking) < 0 &&
         std::abs(braking.norm() - deceleration_mps2_) <= tolerance * deceleration_mps2_ &&
         stop.residual_speed_mps() < 1e-6;
}

void FirmwareMonitor::started_own_stop(const Version& to) {
  check_rule(!is_lifted_);
  check_rule(to.base == executing_.number);
  check_rule(to.number > highest_executed_ && to.number > highest_seen_);
  check_rule(to.incarnation >= acknowledged_ && to.incarnation <= highest_seen_);
  check_rule(to.trajectory.start() > last_report_);
  check_rule(expects_clock_stop_ || to.trajectory.start() > executing_.trajectory.start());
  check_rule(is_own_stop(to.trajectory));
  check_rule(to.inflation_m >= 0 && to.inflation_m <= kMaxInflation_m);
  // The stop starts at the robot's own estimate, so half of the drift bound may be due to the estimate's
  // error.
  const State reference = executing_.trajectory.state_at(to.trajectory.start());
  const double error_m = (to.trajectory.at_start().position_m - reference.position_m).norm();
  check_rule(expects_reboot_stop_ || expects_clock_stop_ ||
             error_m >= 0.5 * drift_bound_m(tracking_bound_m_));
  expects_reboot_stop_ = expects_clock_stop_ = false;
  executing_ = to;
  highest_executed_ = to.number;
  is_own_ = true;
}

void FirmwareMonitor::clock_went_back() {
  last_report_ = Time::min();
  arrival_count_ = 0;
  highest_arrived_ = 0;
  if (is_lifted_)
    lifted();
  else
    expects_clock_stop_ = true;
}

void FirmwareMonitor::lifted() {
  executing_ = Version{};
  is_lifted_ = true;
  is_own_ = expects_clock_stop_ = false;
}

void FirmwareMonitor::put_down() {
  check_rule(is_lifted_ && executing_.number > 0);
  is_lifted_ = false;
}

void FirmwareMonitor::reported(const RobotReport& robot_report) {
  check_rule(!expects_clock_stop_);
  check_rule(robot_report.executing.number == executing_.number);
  check_rule(robot_report.is_off_reference == is_own_ && robot_report.is_lifted == is_lifted_);
  check_rule(robot_report.obeyed_incarnation >= acknowledged_ &&
             robot_report.obeyed_epoch >= acknowledged_epoch_);
  check_rule(is_lifted_ || executing_.trajectory.start() <= robot_report.valid_at);
  check_rule(!robot_report.command || robot_report.command->received_at <= robot_report.valid_at);
  acknowledged_ = std::max(acknowledged_, robot_report.obeyed_incarnation);
  acknowledged_epoch_ = std::max(acknowledged_epoch_, robot_report.obeyed_epoch);
  last_report_ = std::max(last_report_, robot_report.valid_at);
}

}  // namespace sidestep
