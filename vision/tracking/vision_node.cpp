// SPDX-License-Identifier: Apache-2.0
#include "vision/tracking/vision_node.hpp"

#include "common/messaging/senders.hpp"

namespace sidestep {
namespace {

std::uint32_t camera_count(const VisionSpec& vision) {
  return static_cast<std::uint32_t>(vision.columns * vision.rows);
}

}  // namespace

VisionNode::VisionNode(Bus& bus, const Scenario& scenario, Incarnation incarnation, FrameSource source)
    : bus_(bus),
      period_(from_seconds(1 / scenario.vision.rate_hz)),
      next_(bus.now() + period_),
      tracker_(tracker_settings(scenario), roster_of(scenario)),
      watch_(source == FrameSource::kBus ? camera_count(scenario.vision) : 0),
      world_writer_(bus.advertise(topics::kWorld)),
      obstacle_writer_(bus.advertise(topics::kObstacles)),
      counters_(bus, static_cast<std::uint32_t>(Sender::kVision), incarnation,
                [this](DropCounters& drops) { count_drops(drops); }) {
  world_.vision(0);
  world_.header().sender(static_cast<std::uint32_t>(Sender::kVision));
  world_.header().incarnation(incarnation);
  world_.robots().reserve(scenario.robots.size());
  obstacles_.vision(world_.vision());
  obstacles_.header() = world_.header();
  obstacles_.obstacles().reserve(msg::MAX_OBSTACLES);
  if (source == FrameSource::kBus) {
    bus_.subscribe<msg::DetectionFrame>(topics::kDetections,
                                        [this](const msg::DetectionFrame& message) { add_frame(message); });
  }
  bus_.at(next_, [this] { publish(); });
}

void VisionNode::add_frame(const msg::DetectionFrame& message) {
  frame_.assign(message, bus_.now());
  changes_.on_frame(frame_, bus_.now());
  tracker_.update(frame_);
  if (frame_.is_usable()) watch_.on_frame(frame_.camera(), frame_.captured_at());
}

void VisionNode::count_drops(DropCounters& drops) const {
  for (const auto& source : drop_sources_) source(drops);
  tracker_.count_drops(drops);
}

void VisionNode::publish() {
  const Time now = bus_.now();
  tracker_.world_at(now, world_);
  tracker_.obstacles_at(world_, obstacles_);
  if (!watch_.is_complete(now)) obstacles_.complete_within_m(0);
  world_writer_.publish(world_, now);
  obstacle_writer_.publish(obstacles_, now);
  changes_.update(world_, now);
  if (listener_) listener_(world_);
  next_ += period_;
  if (next_ < now) next_ = now + period_;
  bus_.at(next_, [this] { publish(); });
}

}  // namespace sidestep
