// SPDX-License-Identifier: Apache-2.0
#include "common/client/robot_table.hpp"

#include <cmath>

#include "common/messaging/observation_codec.hpp"
#include "common/messaging/order_codec.hpp"
#include "common/protocol/senders.hpp"

namespace sidestep::client {
namespace {

TaskState task_of(const OrderReport& report) {
  if (report.number == 0) return TaskState::kNone;
  if (report.blockage && !report.progress.is_finished()) return TaskState::kBlocked;
  switch (report.progress.state) {
    case msg::OrderState::ORDER_ACCEPTED:
      return TaskState::kWaiting;
    case msg::OrderState::ORDER_DRIVING:
    case msg::OrderState::ORDER_BLOCKED:
      return TaskState::kDriving;
    case msg::OrderState::ORDER_ARRIVED:
    case msg::OrderState::ORDER_LEFT:
      break;
  }
  return TaskState::kArrived;
}

bool is_recent(const std::optional<Time>& at, Time now, Duration timeout) {
  return at && now - *at <= timeout;
}

}  // namespace

void RobotTable::on_status(const msg::OrderStatus& status, Time now) {
  const auto report = decode(status);
  if (!report) return;
  Row& row = rows_[report->robot];
  row.heard_at = now;
  row.robot.is_held = report->is_held;
  row.robot.has_own_order = report->number != 0 && report->client == self_;
  row.robot.task = task_of(*report);
  row.robot.goal_index = report->progress.goal_index;
  row.robot.remaining_s = report->remaining_s;
}

void RobotTable::on_world_state(const msg::WorldState& world, Time now) {
  if (world.header().sender() != static_cast<std::uint32_t>(Sender::kVision)) return;
  for (const msg::TrackedRobot& tracked : world.robots()) {
    const auto observation = decode(tracked, now);
    if (!observation || !std::isfinite(tracked.observed_heading_rad())) continue;
    Row& row = rows_[observation->robot];
    // A world state repeats the last observation of a robot that cameras do not see.
    if (row.observed_at == observation->observed_at) continue;
    row.observed_at = observation->observed_at;
    row.seen_at = now;
    row.robot.pose =
        Pose{observation->position_m.x(), observation->position_m.y(), tracked.observed_heading_rad()};
  }
}

std::vector<Robot> RobotTable::robots(Time now) const {
  std::vector<Robot> robots;
  for (const auto& [id, row] : rows_) {
    Robot& robot = robots.emplace_back(row.robot);
    robot.id = id;
    robot.is_heard = is_recent(row.heard_at, now, kStatusTimeout);
    if (!is_recent(row.seen_at, now, kPoseTimeout)) robot.pose.reset();
  }
  return robots;
}

}  // namespace sidestep::client
