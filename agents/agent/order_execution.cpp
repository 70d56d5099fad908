// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/order_execution.hpp"

#include <utility>

namespace sidestep {

OrderExecution::OrderExecution(const FloorSpec& floor, const RobotSpec& robot)
    : goal_tolerance_m_(floor.goal_tolerance_m),
      start_heading_rad_(robot.start_heading_rad),
      assignment_(robot.id, robot.goals, roster_of(floor)),
      desired_heading_rad_(robot.start_heading_rad) {}

OrderExecution::Changes OrderExecution::on_page(std::shared_ptr<const OrderPage> page) {
  const std::uint64_t revision = assignment_.revision(), zone_revision = assignment_.zone_revision();
  assignment_.on_page(std::move(page));
  return {begin_if_changed(revision), assignment_.zone_revision() != zone_revision};
}

bool OrderExecution::on_execution(const Trajectory& executing, Time at) {
  const Goal* goal = assignment_.goal();
  if (!goal) return false;
  const bool is_at_rest = at >= executing.end();
  has_arrived_ = is_at_rest && (executing.rest_position_m() - goal->position_m).norm() <
                                   goal->tolerance_m.value_or(goal_tolerance_m_);
  if (!has_arrived_) return false;
  const std::uint64_t revision = assignment_.revision();
  assignment_.on_arrival();
  return begin_if_changed(revision);
}

void OrderExecution::on_heartbeat(const CoordinatorHeartbeat& heartbeat) {
  in_charge_ = {heartbeat.sender, heartbeat.incarnation, heartbeat.epoch};
}

bool OrderExecution::choose() {
  const std::uint64_t revision = assignment_.revision();
  assignment_.choose();
  return begin_if_changed(revision);
}

bool OrderExecution::begin_if_changed(std::uint64_t revision) {
  if (assignment_.revision() == revision) return false;
  has_arrived_ = false;
  const Goal* goal = assignment_.goal();
  if (goal) desired_heading_rad_ = goal->heading_rad.value_or(start_heading_rad_);
  return true;
}

bool OrderExecution::coordinator_knows_all_orders(Epoch epoch) const {
  if (assignment_.has_no_orders()) return true;
  return in_charge_.epoch == epoch &&
         assignment_.has_announced_all_orders(in_charge_.coordinator, in_charge_.incarnation);
}

}  // namespace sidestep
