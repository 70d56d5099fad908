// SPDX-License-Identifier: Apache-2.0
#include "simulator/firmware_monitor.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

constexpr double kMaxInflation_m = 1;

// What claims to be higher is refused as malformed.
std::uint64_t obeyable(std::uint64_t number) { return number <= std::uint64_t{1} << 62 ? number : 0; }

}  // namespace

void FirmwareMonitor::command_arrived(const msg::Command& command, Time now) {
  const auto& granted = command.granted();
  highest_seen_ = std::max(highest_seen_, obeyable(command.head().incarnation()));
  if (command.has_version()) highest_seen_ = std::max(highest_seen_, obeyable(granted.version_number()));
  const bool is_old_epoch = command.epoch() < acknowledged_epoch_;
  if (!command.has_version() || is_old_epoch || granted.start_ns() <= to_ns(now)) return;
  const Arrival arrival{granted.version_number(), granted.base(), granted.incarnation(),
                        time_from_ns(granted.start_ns())};
  if (arrival.number <= newest_ && came_in_time(arrival)) return;
  newest_ = std::max(newest_, arrival.number);
  arrivals_[static_cast<std::size_t>(arrival_count_++ % arrivals_.size())] = arrival;
}

bool FirmwareMonitor::came_in_time(const Arrival& wanted) const {
  // Backwards from the latest, which is nearly always the one.
  for (std::uint64_t back = 1; back <= std::min<std::uint64_t>(arrival_count_, arrivals_.size()); ++back) {
    if (arrivals_[static_cast<std::size_t>((arrival_count_ - back) % arrivals_.size())] == wanted)
      return true;
  }
  return false;
}

void FirmwareMonitor::switched(const Version& to) {
  require(to.base == executing_.number);
  require(to.number > highest_executed_);
  require(came_in_time({to.number, to.base, to.incarnation, to.trajectory.start()}));
  require(to.incarnation >= executing_.incarnation && to.incarnation >= acknowledged_);
  require(to.trajectory.start() > last_fact_);
  const State& begins = to.trajectory.at_start();
  if (is_lifted_) {
    // A stand where it will be put down, and only one.
    require(executing_.number == 0 && to.trajectory.phases().empty() && begins.velocity_mps.norm() == 0);
  } else {
    const State left = executing_.trajectory.state_at(to.trajectory.start());
    require((begins.position_m - left.position_m).norm() <= kPositionJump_m &&
            (begins.velocity_mps - left.velocity_mps).norm() <= kVelocityJump_mps);
  }
  executing_ = to;
  highest_executed_ = to.number;
  is_own_ = false;
}

bool FirmwareMonitor::is_own_stop(const Trajectory& stop) const {
  const Vec2& velocity = stop.at_start().velocity_mps;
  if (stop.phases().empty()) return velocity.norm() < 1e-9;
  if (stop.phases().size() > 1) return false;
  const Vec2& braking = stop.phases()[0].acceleration_mps2;
  return std::abs(cross(velocity, braking)) <= 1e-9 * velocity.norm() && velocity.dot(braking) < 0 &&
         std::abs(braking.norm() - deceleration_mps2_) <= 1e-3 * deceleration_mps2_ &&
         stop.residual_speed_mps() < 1e-6;
}

void FirmwareMonitor::broke_off(const Version& to) {
  require(!is_lifted_);
  require(to.base == executing_.number);
  require(to.number > highest_executed_ && to.number > highest_seen_);
  require(to.incarnation >= acknowledged_ && to.incarnation <= highest_seen_);
  require(to.trajectory.start() > last_fact_ && to.trajectory.start() > executing_.trajectory.start());
  require(is_own_stop(to.trajectory));
  require(to.inflation_m >= 0 && to.inflation_m <= kMaxInflation_m);
  // It says itself where it is. Uncertainty may be the other half of the bound.
  const State wanted = executing_.trajectory.state_at(to.trajectory.start());
  const double error_m = (to.trajectory.at_start().position_m - wanted.position_m).norm();
  require(may_have_forgotten_ || error_m >= 0.5 * tracking_bound_m_ + executing_.inflation_m);
  may_have_forgotten_ = false;
  executing_ = to;
  highest_executed_ = to.number;
  is_own_ = true;
}

void FirmwareMonitor::lifted() {
  executing_ = Version{};
  is_lifted_ = true;
  is_own_ = false;
}

void FirmwareMonitor::put_down() {
  require(is_lifted_ && executing_.number > 0);
  is_lifted_ = false;
}

void FirmwareMonitor::reported(const msg::Feedback& fact) {
  require(fact.executing().version_number() == executing_.number);
  require(fact.is_off_reference() == is_own_ && fact.is_lifted() == is_lifted_);
  require(fact.obeyed_incarnation() >= acknowledged_ && fact.obeyed_epoch() >= acknowledged_epoch_);
  require(is_lifted_ || executing_.trajectory.start() <= time_from_ns(fact.at_ns()));
  require(fact.heard_at_ns() <= fact.at_ns());
  acknowledged_ = std::max(acknowledged_, static_cast<Incarnation>(fact.obeyed_incarnation()));
  acknowledged_epoch_ = std::max(acknowledged_epoch_, static_cast<Epoch>(fact.obeyed_epoch()));
  last_fact_ = std::max(last_fact_, time_from_ns(fact.at_ns()));
}

}  // namespace sidestep
