// SPDX-License-Identifier: Apache-2.0
#include "simulator/world/simulator_node.hpp"

#include <algorithm>

#include "common/messaging/robot_codec.hpp"
#include "common/motion/time_to_rest.hpp"
#include "common/protocol/report_period.hpp"
#include "common/protocol/senders.hpp"
#include "simulator/world/disturbance_codec.hpp"

namespace sidestep {
namespace {

using std::chrono::milliseconds;

constexpr Duration kWakePeriod = milliseconds(4);
static_assert(kWakePeriod <= kMaxReportDelay);
constexpr Duration kTruthPeriod{16'666'667};
// Maximum delay of this process that is simulated. After a longer delay all robots would have come to rest,
// so the remaining time is skipped.
constexpr Duration kMaxCatchUp = milliseconds(5000);
constexpr Duration kFrameExpiry = milliseconds(200);
// Version starts farther ahead than this get no timer; the periodic wake-up handles them.
constexpr Duration kMaxTimerAhead = milliseconds(200);
// A body that is slower than this is at rest.
constexpr double kRestingBody_mps = 0.02;
// Before the node finishes, robots rest for this long and for the cameras' delay, so that ground truth and
// detections show them at rest.
constexpr Duration kShownRest = 3 * kTruthPeriod;

}  // namespace

SimulatorNode::SimulatorNode(Bus& bus, const Scenario& scenario, Incarnation incarnation, std::uint64_t seed)
    : bus_(bus),
      cycle_(scenario.cycle),
      delay_(scenario.vision.delay),
      command_loss_(scenario.command_loss),
      publishes_detections_(!scenario.vision.images),
      field_(scenario.field),
      radius_m_(scenario.radius_m),
      incarnation_(incarnation),
      max_stopping_time_(2 * time_to_rest(scenario.limits) + kShownRest + scenario.vision.delay),
      clock_(bus.now()),
      world_(scenario, bus.now(), seed),
      cameras_(scenario, bus.now(), Rng(seed + 1).bits()),
      radio_rng_(Rng(seed + 2).bits()),
      detections_(bus.advertise(topics::kDetections)),
      disturbance_answers_(bus, incarnation),
      truth_(bus.advertise(topics::kTruth)),
      truth_due_(bus.now()),
      counters_(bus, static_cast<std::uint32_t>(Sender::kSimulator), incarnation,
                [this](DropCounters& drops) { count_drops(drops); }) {
  const Time begin = bus.now();
  const std::size_t count = world_.robot_count();
  for (std::size_t i = 0; i < count; ++i) {
    robot_index_[world_.id(i)] = i;
    watched_start_.push_back(begin);
    feedback_.push_back(bus.advertise(topics::kFeedback, world_.id(i)));
    report_due_.push_back(begin + cycle_ * static_cast<Duration::rep>(i) / static_cast<Duration::rep>(count));
    bus.subscribe<msg::Command>(topics::kCommand, world_.id(i),
                                [this, i](const msg::Command& command) { on_command(i, command); });
  }
  if (scenario.laser) {
    lasers_.emplace(scenario, begin, Rng(seed + 3).bits());
    for (std::size_t i = 0; i < count; ++i) scans_.push_back(bus.advertise(topics::kScan, world_.id(i)));
  }
  bus.subscribe<msg::Disturbance>(
      topics::kDisturbance, [this](const msg::Disturbance& disturbance) { on_disturbance(disturbance); });
  bus.at(begin, [this] { wake(); });
}

// Returns the world's time, which continues if the host's clock is set back.
Time SimulatorNode::clock() {
  const Time now = world_.world_time(bus_.now());
  if (now < clock_) world_.on_host_clock_set_back(clock_ - now);
  return clock_ = std::max(clock_, now);
}

void SimulatorNode::at(Time world_time, std::function<void()> callback) {
  bus_.at(world_.host_time(world_time), std::move(callback));
}

void SimulatorNode::wake() {
  const Time now = clock();
  advance(now);
  for (std::size_t i = 0; i < feedback_.size(); ++i) {
    if (report_due_[i] <= now) publish_robot_report(i, now);
  }
  if (truth_due_ <= now) publish_truth(now);
  publish_frames();
  bus_.at(bus_.now() + kWakePeriod, [this] { wake(); });
}

void SimulatorNode::advance(Time now) {
  if (now - world_.time() > kMaxCatchUp) {
    world_.advance(world_.time() + kMaxCatchUp);
    world_.skip_to(now);
  }
  while (true) {
    const bool is_scan = lasers_ && lasers_->next_scan() < cameras_.next_capture();
    const Time next = is_scan ? lasers_->next_scan() : cameras_.next_capture();
    if (next > now) break;
    world_.advance(next);
    if (is_scan)
      publish_scan();
    else
      capture_frame(now);
  }
  world_.advance(now);
  event_logger_.update();
  publish_pending_reports(now);
}

void SimulatorNode::on_command(std::size_t robot, const msg::Command& message) {
  if (radio_rng_.chance(command_loss_)) {
    drops_.count(DropReason::kCommandLost, world_.id(robot));
    return;
  }
  const Time now = clock();
  advance(now);
  if (auto command = decode(message, world_.id(robot), world_.robot_time(robot, now))) {
    if (stopping_since_) command->version.reset();
    world_.on_command(robot, *command, now);
  } else {
    world_.on_malformed_command(robot, now);
  }
  publish_pending_reports(now);
  watch_start(robot, now);
}

void SimulatorNode::on_disturbance(const msg::Disturbance& message) {
  if (disturbance_answers_.repeat(message)) return;
  const Time now = clock();
  advance(now);
  disturbance_answers_.answer(message, apply(message, now));
}

msg::DisturbanceResult SimulatorNode::apply(const msg::Disturbance& message, Time now) {
  const auto robot = robot_index_.find(message.robot());
  const auto disturbance = decode(message, field_, radius_m_);
  const bool is_known = robot != robot_index_.end();
  if (!is_known || !disturbance || !world_.disturb(robot->second, *disturbance, now)) {
    const auto result = !is_known      ? msg::DisturbanceResult::FAULT_UNKNOWN_ROBOT
                        : !disturbance ? msg::DisturbanceResult::FAULT_INVALID
                                       : world_.check_disturbance(robot->second, *disturbance);
    drops_.count(DropReason::kRefusedDisturbance, is_known ? std::optional(robot->first) : std::nullopt);
    event_logger_.on_refused_disturbance(message.robot(), result);
    return result;
  }
  event_logger_.on_disturbance(*disturbance);
  publish_pending_reports(now);
  watch_start(robot->second, now);
  return msg::DisturbanceResult::FAULT_APPLIED;
}

void SimulatorNode::count_drops(DropCounters& drops) const {
  drops.add(drops_);
  world_.count_drops(drops);
  for (const auto& source : drop_sources_) source(drops);
}

bool SimulatorNode::is_commanded() const {
  for (std::size_t i = 0; i < world_.robot_count(); ++i) {
    if (world_.firmware(i).obeyed_incarnation() != 0) return true;
  }
  return false;
}

bool SimulatorNode::come_to_rest() {
  const Time now = bus_.now();
  if (!stopping_since_) stopping_since_ = now;
  if (!moving_robots().empty())
    resting_since_.reset();
  else if (!resting_since_)
    resting_since_ = now;
  return (resting_since_ && now - *resting_since_ >= kShownRest + delay_) ||
         now - *stopping_since_ >= max_stopping_time_;
}

std::vector<RobotId> SimulatorNode::moving_robots() {
  const Time now = clock();
  std::vector<RobotId> moving;
  for (std::size_t i = 0; i < world_.robot_count(); ++i) {
    const Firmware& firmware = world_.firmware(i);
    const bool drives = world_.next_start(i) != Time::max() ||
                        (world_.may_report(i) && !firmware.is_lifted() &&
                         firmware.executing().trajectory.end() > world_.robot_time(i, now));
    if (drives || world_.bodies()[i].velocity_mps().norm() >= kRestingBody_mps)
      moving.push_back(world_.id(i));
  }
  return moving;
}

void SimulatorNode::watch_start(std::size_t robot, Time now) {
  const Time start = world_.next_start(robot);
  if (start == watched_start_[robot] || start - now > kMaxTimerAhead) return;
  watched_start_[robot] = start;
  at(start, [this, robot] { on_start(robot); });
}

void SimulatorNode::on_start(std::size_t robot) {
  const Time now = clock();
  advance(now);
  if (world_.next_start(robot) > now) return;
  publish_robot_report(robot, now);
}

void SimulatorNode::publish_robot_report(std::size_t robot, Time now) {
  // Reads the clock first: a robot whose clock was set back reports nothing until it has made its own stop.
  (void)world_.robot_time(robot, now);
  if (!world_.may_report(robot)) {
    report_due_[robot] = now + cycle_;
    world_.clear_pending_report(robot);
    return;
  }
  RobotReport robot_report = world_.robot_report(robot, now);
  robot_report.robot_incarnation += incarnation_;
  msg::Feedback message = encode(robot_report);
  feedback_[robot].publish(message, bus_.now());
  report_due_[robot] = now + cycle_;
  world_.clear_pending_report(robot);
  watch_start(robot, now);
}

void SimulatorNode::publish_pending_reports(Time now) {
  while (!world_.pending_reports().empty()) publish_robot_report(world_.pending_reports().back(), now);
}

void SimulatorNode::publish_truth(Time now) {
  world_.fill(truth_message_);
  truth_message_.simulator(static_cast<std::uint32_t>(Sender::kSimulator));
  truth_message_.header().sender(static_cast<std::uint32_t>(Sender::kSimulator));
  truth_message_.header().incarnation(incarnation_);
  truth_.publish(truth_message_, bus_.now());
  truth_due_ = std::max(truth_due_ + kTruthPeriod, now);
}

void SimulatorNode::capture_frame(Time now) {
  auto slot =
      std::find_if(frames_.begin(), frames_.end(), [](const PendingFrame& f) { return !f.is_waiting; });
  if (slot == frames_.end()) slot = frames_.emplace(frames_.end());
  const Time captured_at = world_.time();
  const Vec2* ball = world_.ball() ? &world_.ball()->state().position_m : nullptr;
  // Robots with lasers must see opponents themselves.
  const auto opponents = lasers_ ? std::span<const Circle>() : world_.opponents().discs();
  cameras_.capture(captured_at, {world_.bodies(), ball, opponents, world_.vision_faults()}, slot->message);
  slot->message.captured_at_ns(to_ns(world_.host_time(captured_at)));
  slot->publish_at = captured_at + delay_;
  if (slot->publish_at + kFrameExpiry < now) return;
  if (capture_listener_) capture_listener_(slot->message.camera(), world_.host_time(captured_at));
  slot->is_waiting = true;
  at(slot->publish_at, [this] { publish_frames(); });
}

void SimulatorNode::publish_scan() {
  const std::size_t robot = lasers_->next_robot();
  if (!lasers_->scan(world_, scan_message_)) return;
  scan_message_.header().sender(world_.id(robot));
  scan_message_.header().incarnation(incarnation_);
  scans_[robot].publish(scan_message_, bus_.now());
}

void SimulatorNode::publish_frames() {
  const Time now = clock();
  for (PendingFrame& frame : frames_) {
    if (!frame.is_waiting || frame.publish_at > now) continue;
    frame.message.header().sender(static_cast<std::uint32_t>(Sender::kSimulator));
    frame.message.header().incarnation(incarnation_);
    if (publishes_detections_) detections_.publish(frame.message, bus_.now());
    if (detection_listener_) detection_listener_(frame.message);
    frame.is_waiting = false;
  }
}

}  // namespace sidestep
