// SPDX-License-Identifier: Apache-2.0
#include "common/client/conversion.hpp"

#include <algorithm>

#include "common/messaging/order_codec.hpp"

namespace sidestep::client {
namespace {

OrderPhase public_phase(sidestep::OrderPhase phase) {
  switch (phase) {
    case sidestep::OrderPhase::kSent:
      return OrderPhase::kSent;
    case sidestep::OrderPhase::kAccepted:
      return OrderPhase::kAccepted;
    case sidestep::OrderPhase::kDriving:
      return OrderPhase::kDriving;
    case sidestep::OrderPhase::kBlocked:
      return OrderPhase::kBlocked;
    case sidestep::OrderPhase::kArrived:
      return OrderPhase::kArrived;
    case sidestep::OrderPhase::kReplaced:
      return OrderPhase::kReplaced;
    case sidestep::OrderPhase::kRefused:
      break;
  }
  return OrderPhase::kRefused;
}

Refusal refusal_of(msg::OrderResult result) {
  switch (result) {
    case msg::OrderResult::RESULT_UNKNOWN_ROBOT:
      return Refusal::kUnknownRobot;
    case msg::OrderResult::RESULT_OUTSIDE_FIELD:
      return Refusal::kOutsideField;
    case msg::OrderResult::RESULT_TOO_MANY:
      return Refusal::kTooMany;
    case msg::OrderResult::RESULT_REMEMBERED:
    case msg::OrderResult::RESULT_REPLACED:
    case msg::OrderResult::RESULT_MALFORMED:
      break;
  }
  return Refusal::kMalformed;
}

bool is_none_or_positive(const std::optional<double>& value) { return !value || *value > 0; }

}  // namespace

OrderState state_of(const SentOrder& sent) {
  OrderState state;
  state.phase = public_phase(sent.phase);
  if (state.phase == OrderPhase::kRefused) state.refusal = refusal_of(sent.refusal);
  state.goal_index = sent.goal_index;
  const bool drives = sent.order.kind == msg::OrderKind::ORDER_GO;
  state.is_over = is_final(sent.phase) || (!drives && sent.phase == sidestep::OrderPhase::kAccepted);
  return state;
}

bool stays(const SentOrder& sent, const OrderState& state) {
  return is_final(sent.phase) || (state.is_over && sent.order.kind != msg::OrderKind::ORDER_ZONE);
}

sidestep::Zone to_zone(const Zone& zone) {
  sidestep::Zone result;
  for (const Point& corner : zone.corners) result.corners_m.emplace_back(corner.x_m, corner.y_m);
  result.radius_m = zone.radius_m;
  result.speed_limit_mps = zone.speed_limit_mps;
  return result;
}

std::vector<sidestep::Goal> to_goals(const std::vector<Goal>& goals) {
  std::vector<sidestep::Goal> result;
  for (const Goal& goal : goals)
    result.push_back({{goal.x_m, goal.y_m}, goal.heading_rad, goal.speed_limit_mps, goal.tolerance_m});
  return result;
}

bool is_well_formed(sidestep::Order order, Time now) {
  order.client = static_cast<ClientId>(Sender::kClient);
  order.number = static_cast<OrderNumber>(to_ns(now));
  if (order.goals.size() > msg::MAX_ORDER_POSES) return false;
  // In messages, zero means that there is no value.
  const auto has_valid_limits = [](const sidestep::Goal& goal) {
    return is_none_or_positive(goal.speed_limit_mps) && is_none_or_positive(goal.tolerance_m);
  };
  return std::ranges::all_of(order.goals, has_valid_limits) &&
         is_none_or_positive(order.zone.speed_limit_mps) && decode(encode(order), now).has_value();
}

}  // namespace sidestep::client
