// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/agent/motion_planner.hpp"
#include "agents/agent/negotiation.hpp"
#include "agents/agent/observations.hpp"
#include "agents/agent/order_execution.hpp"
#include "idl/monitor.hpp"

namespace sidestep {

/// An agent's status at a time by its robot's clock, without the durations, which the caller measures.
msg::AgentStatus status_of(RobotId robot, const Negotiation& negotiation, const OwnReports& own,
                           const OrderExecution& orders, const MotionPlanner& planner, Time now);

}  // namespace sidestep
