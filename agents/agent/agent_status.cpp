// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/agent_status.hpp"

namespace sidestep {
namespace {

msg::AgentState state_of(const Negotiation& negotiation, const OrderExecution& orders, Time now) {
  const Assignment& assignment = orders.assignment();
  using enum msg::AgentState;
  if (!negotiation.is_fenced()) return AGENT_FENCING;
  if (negotiation.needs_registration()) return AGENT_REGISTERING;
  if (negotiation.is_absent()) return AGENT_ABSENT;
  if (assignment.is_held()) return AGENT_HELD;
  if (!assignment.is_known()) return AGENT_WAITING;
  if (orders.has_arrived()) return AGENT_ARRIVED;
  if (!assignment.goal()) return AGENT_WITHOUT_ORDER;
  return negotiation.may_propose(now) ? AGENT_DRIVING : AGENT_WAITING;
}

}  // namespace

msg::AgentStatus status_of(RobotId robot, const Negotiation& negotiation, const OwnReports& own,
                           const OrderExecution& orders, const MotionPlanner& planner, Time now) {
  const Assignment& assignment = orders.assignment();
  const Negotiation::Counts& counts = negotiation.counts();
  msg::AgentStatus status;
  status.robot(robot);
  status.agent_state(state_of(negotiation, orders, now));
  status.goal_index(static_cast<std::uint32_t>(assignment.goal_index()));
  if (const Goal* goal = assignment.goal())
    status.distance_to_go_m((goal->position_m - own.estimate().position_m).norm());
  status.speed_mps(own.estimate().velocity_mps.norm());
  status.cycles(counts.cycles);
  status.missed_cycles(counts.missed);
  status.reference_losses(own.reference_losses());
  status.route_changes(planner.route_changes());
  status.lost_versions(counts.lost);
  status.proposals(counts.proposals);
  status.grants(counts.grants);
  status.denials(counts.denials);
  return status;
}

}  // namespace sidestep
