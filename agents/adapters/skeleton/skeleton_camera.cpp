// SPDX-License-Identifier: Apache-2.0
#include "agents/adapters/skeleton/skeleton_camera.hpp"

#include "common/messaging/detected_obstacles.hpp"
#include "common/messaging/topics.hpp"
#include "common/protocol/senders.hpp"

namespace sidestep {

SkeletonCamera::SkeletonCamera(Bus& bus, const Scenario& scenario, const std::vector<RobotId>& robots,
                               const SkeletonDriver& driver, Incarnation incarnation)
    : bus_(bus),
      driver_(driver),
      cameras_(static_cast<std::uint32_t>(scenario.vision.columns * scenario.vision.rows)),
      period_(from_seconds(1 / scenario.vision.rate_hz)),
      captured_at_(bus.now()),
      incarnation_(incarnation),
      frames_(bus.advertise(topics::kDetections)) {
  for (const RobotId robot : robots) robots_.push_back(*find_robot(scenario, robot));
  bus.at(bus.now() + period_, [this] { capture(); });
}

void SkeletonCamera::capture() {
  bus_.at(bus_.now() + period_, [this] { capture(); });
  // The driver knows the pose of its bases at the time of the latest commands.
  const Time captured_at = robots_.empty() ? bus_.now() : driver_.base(robots_.front().id).measured_at;
  if (captured_at <= captured_at_) return;
  captured_at_ = captured_at;
  for (std::uint32_t camera = 0; camera < cameras_; ++camera) {
    msg::DetectionFrame frame;
    frame.camera(camera);
    // The simulator's cameras send in its name, too.
    frame.header().sender(static_cast<std::uint32_t>(Sender::kSimulator));
    frame.header().incarnation(incarnation_);
    frame.captured_at_ns(to_ns(captured_at));
    frame.ball_count(0);
    for (const RobotSpec& robot : robots_) {
      if (camera > 0) break;
      const OdometryReport& base = driver_.base(robot.id);
      const Vec2 at_m = robot.start_m + rotated(base.position_m, robot.start_heading_rad);
      msg::RobotDetection seen;
      seen.robot(robot.id);
      seen.x_m(at_m.x());
      seen.y_m(at_m.y());
      seen.heading_rad(wrapped_rad(robot.start_heading_rad + base.heading_rad));
      seen.confidence(1);
      frame.robots().push_back(seen);
    }
    set_obstacles({}, frame);
    frames_.publish(frame, bus_.now());
  }
}

}  // namespace sidestep
