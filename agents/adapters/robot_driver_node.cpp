// SPDX-License-Identifier: Apache-2.0
#include "agents/adapters/robot_driver_node.hpp"

#include <algorithm>

#include "common/messaging/robot_codec.hpp"
#include "common/motion/time_to_rest.hpp"
#include "common/protocol/report_period.hpp"
#include "common/protocol/senders.hpp"
#include "common/robot/own_stop_text.hpp"

namespace sidestep {
namespace {

using std::chrono::milliseconds;

static_assert(DrivenRobot::kPeriod <= kMaxReportDelay);
// Version starts farther ahead than this get no timer; the control period handles them.
constexpr Duration kMaxTimerAhead = milliseconds(200);
// At the end of the process, rest is commanded for this time, and longer while fixes show that bases move.
// Some bases keep the velocity of the last command that they receive.
constexpr Duration kMinStandstill = milliseconds(300), kMaxStandstill = milliseconds(2000);

}  // namespace

RobotDriverNode::RobotDriverNode(Bus& bus, const Scenario& scenario, const std::vector<RobotId>& robots,
                                 Incarnation incarnation, const DriveSettings& settings, Driver& driver,
                                 const std::string& memory_folder)
    : bus_(bus),
      cycle_(scenario.cycle),
      incarnation_(incarnation),
      driver_(driver),
      clock_(bus.now()),
      next_tick_(bus.now()),
      latency_(settings.latency),
      max_stopping_time_(2 * time_to_rest(settings.limits)),
      counters_(bus, static_cast<std::uint32_t>(Sender::kRobots), incarnation,
                [this](DropCounters& drops) { count_drops(drops); }) {
  const Time begin = bus.now();
  robots_.reserve(robots.size());
  for (const RobotId id : robots) {
    index_of_[id] = robots_.size();
    Entry& entry = robots_.emplace_back();
    entry.memory = std::make_unique<RobotMemory>(memory_folder, id);
    entry.robot = std::make_unique<DrivenRobot>(id, settings, entry.memory->state(), begin);
    entry.robot_report = bus.advertise(topics::kFeedback, id);
    entry.report_due = begin + cycle_ * static_cast<Duration::rep>(robots_.size()) /
                                   static_cast<Duration::rep>(robots.size());
    bus.subscribe<msg::Command>(topics::kCommand, id,
                                [this, &entry](const msg::Command& command) { on_command(entry, command); });
  }
  driver.on_odometry([this](const OdometryReport& report) {
    const auto found = index_of_.find(report.robot);
    if (found != index_of_.end()) robots_[found->second].robot->on_odometry(report, clock());
  });
  bus.at(begin, [this] { tick(); });
}

// This clock never goes back; otherwise earlier reports could become untrue.
Time RobotDriverNode::clock() { return clock_ = std::max(clock_, bus_.now()); }

void RobotDriverNode::tick() {
  const Time now = clock();
  commands_.clear();
  for (Entry& entry : robots_)
    commands_.push_back({entry.robot->id(), entry.robot->tick(now, *entry.memory)});
  driver_.send(commands_);
  for (Entry& entry : robots_) {
    report_memory(entry);
    publish_if_changed(entry, now);
    if (entry.report_due <= now) publish(entry, now);
  }
  // Skips missed periods.
  next_tick_ = std::max(next_tick_ + DrivenRobot::kPeriod, now);
  bus_.at(next_tick_, [this] { tick(); });
}

void RobotDriverNode::on_command(Entry& entry, const msg::Command& message) {
  const Time now = clock();
  if (auto command = decode(message, entry.robot->id(), now)) {
    // Fixes are still needed.
    if (stopping_since_) command->version.reset();
    entry.robot->on_command(*command, now, *entry.memory);
  } else {
    entry.robot->on_malformed_command(now);
  }
  publish_if_changed(entry, now);
  watch_start(entry, now);
}

void RobotDriverNode::watch_start(Entry& entry, Time now) {
  const Time start = entry.robot->next_start();
  if (start == entry.watched_start || start - now > kMaxTimerAhead) return;
  entry.watched_start = start;
  bus_.at(start, [this, &entry] { publish(entry, clock()); });
}

void RobotDriverNode::publish_if_changed(Entry& entry, Time now) {
  const auto& side = entry.robot->side();
  if (side.executing().number != entry.executing || side.acknowledged_incarnation() != entry.incarnation ||
      side.obeyed_epoch() != entry.epoch || entry.robot->may_report() != entry.is_known)
    publish(entry, now);
}

void RobotDriverNode::publish(Entry& entry, Time now) {
  entry.report_due = now + cycle_;
  if (entry.is_known != entry.robot->may_report()) {
    entry.is_known = entry.robot->may_report();
    if (!entry.is_known)
      events_.report(LogLevel::kWarning, entry.robot->id(), "robot {} no longer knows its pose",
                     entry.robot->id());
  }
  if (!entry.is_known) return;
  RobotReport robot_report = entry.robot->robot_report(now);
  robot_report.robot_incarnation = incarnation_;
  report_changes(entry);
  msg::Feedback message = encode(robot_report);
  entry.robot_report.publish(message, now);
  watch_start(entry, now);
}

void RobotDriverNode::report_changes(Entry& entry) {
  const auto& side = entry.robot->side();
  const bool is_new = side.executing().number != entry.executing;
  entry.executing = side.executing().number;
  entry.incarnation = side.acknowledged_incarnation();
  entry.epoch = side.obeyed_epoch();
  if (is_new && side.is_off_reference())
    events_.report(
        side.own_stop_reason() == robot::OwnStopReason::kRestart ? LogLevel::kInfo : LogLevel::kWarning,
        entry.robot->id(), "robot {} makes its own stop: {}", entry.robot->id(),
        to_text(side.own_stop_reason()));
}

void RobotDriverNode::report_memory(Entry& entry) {
  const std::string& failure = entry.memory->failure();
  if (failure == entry.memory_failure) return;
  entry.memory_failure = failure;
  if (failure.empty())
    events_.report(LogLevel::kInfo, entry.robot->id(), "robot {} can store its state again",
                   entry.robot->id());
  else
    events_.report(LogLevel::kError, entry.robot->id(),
                   "robot {} refuses commands because it cannot store its state: {}", entry.robot->id(),
                   failure);
}

bool RobotDriverNode::is_commanded() const {
  return std::ranges::any_of(
      robots_, [](const Entry& entry) { return entry.robot->side().obeyed_incarnation() != 0; });
}

bool RobotDriverNode::come_to_rest() {
  const Time now = clock();
  if (!stopping_since_) stopping_since_ = now;
  const auto all = [this](auto condition) {
    return std::ranges::all_of(robots_, [&](const Entry& entry) { return condition(*entry.robot); });
  };
  if (!stand_still_since_) {
    // A robot that something keeps moving makes one stop of its own after the other.
    const bool is_overdue = now - *stopping_since_ >= max_stopping_time_;
    const bool have_ended = all([now](const DrivenRobot& robot) { return robot.is_at_rest(now); });
    if (!have_ended && !is_overdue) return false;
    stand_still_since_ = now;
    for (Entry& entry : robots_) entry.robot->stand_still();
  }
  const Duration commanded = now - *stand_still_since_ - latency_;
  if (commanded < kMinStandstill) return false;
  return commanded >= kMaxStandstill ||
         all([now](const DrivenRobot& robot) { return robot.is_base_at_rest(now); });
}

std::vector<RobotId> RobotDriverNode::moving_robots() {
  const Time now = clock();
  std::vector<RobotId> moving;
  for (const Entry& entry : robots_) {
    if (!entry.robot->is_at_rest(now) || !entry.robot->is_base_at_rest(now))
      moving.push_back(entry.robot->id());
  }
  return moving;
}

void RobotDriverNode::count_drops(DropCounters& drops) const {
  for (const Entry& entry : robots_) {
    const RobotId id = entry.robot->id();
    const robot::Counts& counts = entry.robot->side().counts();
    drops.count(DropReason::kMalformedCommand, id, counts.refused_malformed);
    drops.count(DropReason::kFencedCommand, id, counts.refused_fenced);
    drops.count(DropReason::kLateVersion, id, counts.refused_late);
    drops.count(DropReason::kWrongBase, id, counts.refused_base);
    drops.count(DropReason::kUnstoredCommand, id, counts.refused_unstored);
    drops.count(DropReason::kMisdatedOdometry, id, entry.robot->misdated_odometry());
  }
  driver_.count_drops(drops);
}

}  // namespace sidestep
