// SPDX-License-Identifier: Apache-2.0
#include "vision/tracking/vision_node.hpp"

#include <numeric>

#include "common/protocol/senders.hpp"

namespace sidestep {

std::vector<std::uint32_t> cameras_of(const VisionSpec& vision) {
  std::vector<std::uint32_t> cameras(static_cast<std::size_t>(vision.columns * vision.rows));
  std::iota(cameras.begin(), cameras.end(), 0U);
  return cameras;
}

VisionNode::VisionNode(Bus& bus, const Scenario& scenario, Incarnation incarnation, FrameSource source,
                       const std::vector<std::uint32_t>& cameras)
    : bus_(bus),
      period_(from_seconds(1 / scenario.vision.rate_hz)),
      next_(bus.now() + period_),
      max_lead_(max_vision_lead(max_clock_difference(scenario.clock_bound_s))),
      offsets_(cameras),
      tracker_(tracker_settings(scenario), roster_of(scenario)),
      handovers_(tracker_.configured_noise_m()),
      watch_(cameras),
      world_writer_(bus.advertise(topics::kWorld)),
      obstacle_writer_(bus.advertise(topics::kObstacles)),
      event_logger_(events_, cameras, vision_error_bound_m(scenario.tracking_bound_m)),
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

void VisionNode::add_frame(const msg::DetectionFrame& message, Duration date_uncertainty) {
  if (!watch_.has(message.camera())) {
    ++unknown_cameras_;
    event_logger_.on_unknown_camera(message.camera());
    return;
  }
  frame_.assign(message, bus_.now(), max_lead_, date_uncertainty);
  event_logger_.on_frame(frame_, bus_.now());
  if (frame_.is_usable()) {
    offsets_.add(frame_);
    frame_.translate(offsets_.correction_m(frame_.camera()));
    handovers_.shift(frame_);
  }
  tracker_.update(frame_);
  if (frame_.is_usable()) watch_.on_frame(frame_.camera(), frame_.captured_at());
}

void VisionNode::count_drops(DropCounters& drops) const {
  for (const auto& source : drop_sources_) source(drops);
  tracker_.count_drops(drops);
  drops.count(DropReason::kMalformedFrame, std::nullopt, unknown_cameras_);
}

void VisionNode::on_clock_set_back(Duration by) {
  offsets_.forget();
  handovers_.forget();
  tracker_.forget();
  watch_.forget();
  next_ -= by;
}

void VisionNode::publish() {
  const Time now = bus_.now();
  if (now < next_ - period_) on_clock_set_back(next_ - now);
  offsets_.advance(period_);
  handovers_.advance(period_);
  tracker_.set_camera_error(offsets_.noise_m());
  tracker_.world_at(now, world_);
  tracker_.obstacles_at(world_, obstacles_);
  if (!watch_.is_complete(now)) obstacles_.complete_within_m(0);
  world_writer_.publish(world_, now);
  obstacle_writer_.publish(obstacles_, now);
  event_logger_.update(world_, now);
  event_logger_.update(offsets_.pairs(), now);
  if (listener_) listener_(world_);
  next_ += period_;
  if (next_ < now) next_ = now + period_;
  bus_.at(next_, [this] { publish(); });
}

}  // namespace sidestep
