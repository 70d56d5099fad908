// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/conformance/robot_probe.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "common/messaging/observation_codec.hpp"
#include "common/messaging/robot_codec.hpp"
#include "common/protocol/report_period.hpp"

namespace sidestep {
namespace {

constexpr std::size_t kMaxExecuted = 256, kMaxUnjudged = 256;
// A report may arrive this much later than the one before: the network and the scheduling of both processes
// delay reports by different times.
constexpr Duration kMaxDelayVariation = std::chrono::milliseconds(15);

}  // namespace

RobotProbe::RobotProbe(Bus& bus, const Scenario& scenario, RobotId robot, Incarnation first)
    : incarnation(first),
      epoch(first),
      bus_(bus),
      robot_(robot),
      cycle_(scenario.cycle),
      writer_(bus.advertise(topics::kCommand, robot)) {
  bus.subscribe<msg::Feedback>(topics::kFeedback, robot,
                               [this](const msg::Feedback& message) { on_robot_report(message); });
  bus.subscribe<msg::WorldState>(topics::kWorld,
                                 [this](const msg::WorldState& message) { on_world_state(message); });
}

Duration RobotProbe::robot_clock_offset() const {
  const auto offset = clock_offset();
  return offset ? offset->middle() : Duration{0};
}

Time RobotProbe::robot_now() const { return bus_.now() + robot_clock_offset(); }

Duration RobotProbe::max_gap() const { return max_report_gap(cycle_) + kMaxDelayVariation; }

std::optional<std::string> RobotProbe::why_busy() const {
  const auto ms = [](Duration duration) { return to_seconds(duration) * 1e3; };
  if (longest_gap_ > max_gap())
    return fmt::format("reports came {:.0f} ms apart, not {:.0f} ms", ms(longest_gap_), ms(max_gap()));
  // Versions are sent three cycles before they must have arrived, and again in the next cycle.
  const Duration max_delay = 2 * cycle_;
  if (longest_command_delay_ > max_delay)
    return fmt::format("a command took {:.0f} ms to arrive, not {:.0f} ms", ms(longest_command_delay_),
                       ms(max_delay));
  return std::nullopt;
}

void RobotProbe::send_command() {
  if (!sends_commands) return;
  Command command;
  command.robot = robot_;
  command.incarnation = incarnation;
  command.epoch = epoch;
  command.version = version;
  // Dates the fix by the robot's clock, so that a wrong clock affects only the clock row.
  if (fix_)
    command.fix =
        PoseFix{fix_->captured_at + robot_clock_offset(), fix_->position_m + fix_error_m, fix_->heading_rad};
  fix_.reset();
  if (robot_report_) command.desired_heading_rad = desired_heading_rad.value_or(robot_report_->heading_rad);
  send(encode(command));
}

void RobotProbe::send(msg::Command message) { writer_.publish(message, bus_.now()); }

void RobotProbe::on_robot_report(const msg::Feedback& message) {
  const Time now = bus_.now();
  const auto robot_report = decode(message, robot_, now + std::chrono::hours(1));
  if (!robot_report) {
    ++malformed_reports_;
    return;
  }
  if (report_count_++ > 0) {
    longest_gap_ = std::max(longest_gap_, now - report_at_);
    const std::uint64_t number = message.header().message_number();
    constexpr std::uint64_t kMaxLost = 1000;
    const std::uint64_t made = number > message_number_ ? std::min(number - message_number_, kMaxLost) : 1;
    longest_gap_at_robot_ = std::max(
        longest_gap_at_robot_, (robot_report->valid_at - robot_report_->valid_at) / static_cast<int>(made));
  }
  message_number_ = message.header().message_number();
  if (robot_report->command) {
    const Duration delay = robot_report->command->received_at - robot_report->command->sent_at;
    if (const auto offset = clock_offset())
      longest_command_delay_ = std::max(longest_command_delay_, delay - offset->middle());
    (void)clock_.add(
        {robot_report->command->sent_at, robot_report->command->received_at, robot_report->valid_at, now});
  }
  robot_report_ = *robot_report;
  report_at_ = now;
  const bool is_new = executed_.empty() || executed_.back().version.number != robot_report->executing.number;
  if (is_new) executed_.push_back({robot_report->executing, robot_report->is_off_reference});
  if (executed_.size() > kMaxExecuted) executed_.pop_front();
  take_samples();
}

void RobotProbe::on_world_state(const msg::WorldState& message) {
  for (const msg::TrackedRobot& robot : message.robots()) {
    if (robot.robot() != robot_) continue;
    const auto seen = decode(robot, bus_.now());
    if (!seen || (seen_ && seen->observed_at <= seen_->observed_at)) continue;
    seen_ = seen;
    seen_heading_rad_.reset();
    if (std::isfinite(robot.observed_heading_rad())) {
      seen_heading_rad_ = robot.observed_heading_rad();
      fix_ = PoseFix{seen->observed_at, seen->position_m, robot.observed_heading_rad()};
    }
    pending_observations_.push_back(*seen);
    if (pending_observations_.size() > kMaxUnjudged) pending_observations_.pop_front();
  }
}

const Version* RobotProbe::executed_at(Time robot_time) const {
  for (auto executed = executed_.rbegin(); executed != executed_.rend(); ++executed) {
    if (executed->version.trajectory.start() <= robot_time) return &executed->version;
  }
  return nullptr;
}

// A report shows what was executed up to its time.
void RobotProbe::take_samples() {
  while (!pending_observations_.empty() &&
         pending_observations_.front().observed_at + robot_clock_offset() < robot_report_->valid_at) {
    const RobotObservation seen = pending_observations_.front();
    pending_observations_.pop_front();
    const Time at = seen.observed_at + robot_clock_offset();
    const auto executed = std::find_if(executed_.rbegin(), executed_.rend(), [&](const Executed& one) {
      return one.version.trajectory.start() <= at;
    });
    if (executed == executed_.rend() || !on_sample_) continue;
    on_sample_({seen.observed_at, at, seen.position_m, executed->version.trajectory.motion_at(at),
                executed->version.number, executed->is_off_reference});
  }
}

}  // namespace sidestep
