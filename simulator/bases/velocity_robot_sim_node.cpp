// SPDX-License-Identifier: Apache-2.0
#include "simulator/bases/velocity_robot_sim_node.hpp"

#include <algorithm>

#include "common/protocol/senders.hpp"
#include "common/random/rng.hpp"

namespace sidestep {
namespace {

using std::chrono::milliseconds;

constexpr Duration kWakePeriod = milliseconds(2);
constexpr Duration kTruthPeriod{16'666'667};
// Longest pause of this process after which the missed time is simulated. After a longer pause it is skipped.
constexpr Duration kMaxCatchUp = milliseconds(1000);
constexpr auto kSender = static_cast<std::uint32_t>(Sender::kSimulator);

}  // namespace

VelocityRobotSimNode::VelocityRobotSimNode(Bus& bus, const Scenario& scenario,
                                           const BaseFloorSettings& settings, Incarnation incarnation,
                                           std::uint64_t seed)
    : bus_(bus),
      delay_(scenario.vision.delay),
      incarnation_(incarnation),
      begin_(bus.now()),
      clock_(begin_, settings.pace, Rng(seed + 1).bits()),
      world_(scenario, settings.team_size, settings.bases, begin_),
      cameras_(world_.floor(), begin_, Rng(seed).bits(), settings.camera_error_m),
      detections_(bus.advertise(topics::kDetections)),
      truth_(bus.advertise(topics::kTruth)),
      truth_due_(begin_),
      advanced_at_(begin_),
      counters_(bus, kSender, incarnation, [this](DropCounters& drops) {
        for (const auto& source : drop_sources_) source(drops);
      }) {
  place_robots(world_, settings.starts, Rng(seed + 2).bits());
  bus.at(bus.now(), [this] { wake(); });
}

BaseWorld& VelocityRobotSimNode::world_now() {
  const Time now = simulated_now();
  const bool was_paused = bus_.now() - advanced_at_ > kMaxCatchUp;
  advanced_at_ = bus_.now();
  if (was_paused) {
    clock_.resume(world_.time(), bus_.now());
    events_.report(LogLevel::kWarning, {}, "the simulation was paused");
    return world_;
  }
  while (cameras_.next_capture() <= now) {
    world_.advance(cameras_.next_capture());
    capture();
  }
  world_.advance(now);
  return world_;
}

void VelocityRobotSimNode::wake() {
  world_now();
  publish_frames();
  if (truth_due_ <= bus_.now()) publish_truth();
  bus_.at(bus_.now() + kWakePeriod, [this] { wake(); });
}

void VelocityRobotSimNode::capture() {
  PendingFrame& frame = frames_.emplace_back();
  const Vec2* const ball_m = world_.ball() ? &world_.ball()->state().position_m : nullptr;
  const Time captured_at = world_.time();
  cameras_.capture(captured_at, {world_.bodies(), ball_m}, frame.message);
  frame.message.captured_at_ns(to_ns(clock_.clock(captured_at)));
  frame.captured_at = captured_at;
  frame.publish_at = captured_at + delay_;
}

void VelocityRobotSimNode::publish_frames() {
  const Time now = simulated_now();
  std::size_t published = 0;
  for (; published < frames_.size() && frames_[published].publish_at <= now; ++published) {
    PendingFrame& frame = frames_[published];
    msg::DetectionFrame& message = frame.message;
    message.header().sender(kSender);
    message.header().incarnation(incarnation_);
    detections_.publish(message, bus_.now());
    if (detection_listener_) detection_listener_(message, frame.captured_at);
  }
  frames_.erase(frames_.begin(), frames_.begin() + static_cast<std::ptrdiff_t>(published));
}

void VelocityRobotSimNode::publish_truth() {
  world_.fill(truth_message_);
  truth_message_.valid_at_ns(to_ns(clock_.clock(world_.time())));
  for (msg::TrueRobotState& robot : truth_message_.robots()) {
    if (robot.disturbance_end_ns() < 0) continue;
    DatedDisturbance& disturbance = disturbances_[robot.robot()];
    if (const std::int64_t end_ns = robot.disturbance_end_ns(); disturbance.simulated_ns != end_ns)
      disturbance = {end_ns, to_ns(clock_.clock(time_from_ns(end_ns)))};
    robot.disturbance_end_ns(disturbance.real_ns);
  }
  truth_message_.simulator(kSender);
  truth_message_.header().sender(kSender);
  truth_message_.header().incarnation(incarnation_);
  truth_.publish(truth_message_, bus_.now());
  truth_due_ = std::max(truth_due_ + kTruthPeriod, bus_.now());
  report_contacts();
}

void VelocityRobotSimNode::report_contacts() {
  const std::uint64_t contacts = truth_message_.contacts();
  if (contacts == reported_contacts_) return;
  const msg::ContactPair& last = truth_message_.recent_contacts()[(contacts - 1) % msg::MAX_CONTACTS];
  if (last.second() == msg::NO_ROBOT)
    events_.report(LogLevel::kWarning, last.first(), "robot {} touches an obstacle; {} contacts so far",
                   last.first(), contacts);
  else
    events_.report(LogLevel::kWarning, last.first(), "robots {} and {} touch; {} contacts so far",
                   last.first(), last.second(), contacts);
  reported_contacts_ = contacts;
}

}  // namespace sidestep
