// SPDX-License-Identifier: Apache-2.0
#include "deploy/order/order_text.hpp"

#include <fmt/format.h>

#include "common/messaging/enumerator.hpp"

namespace sidestep {
namespace {

const char* phase_text(OrderPhase phase) {
  switch (phase) {
    case OrderPhase::kSent:
      return "sent, not answered";
    case OrderPhase::kAccepted:
      return "accepted";
    case OrderPhase::kDriving:
      return "driving";
    case OrderPhase::kBlocked:
      return "blocked";
    case OrderPhase::kArrived:
      return "arrived";
    case OrderPhase::kReplaced:
      return "replaced by a later order";
    case OrderPhase::kRefused:
      break;
  }
  return "refused";
}

const char* refusal_text(msg::OrderResult result) {
  switch (result) {
    case msg::OrderResult::RESULT_UNKNOWN_ROBOT:
      return "the scenario has no such robot";
    case msg::OrderResult::RESULT_OUTSIDE_FIELD:
      return "a goal is outside the field";
    case msg::OrderResult::RESULT_TOO_MANY:
      return "the coordinator cannot remember more holds or zones";
    case msg::OrderResult::RESULT_REMEMBERED:
    case msg::OrderResult::RESULT_REPLACED:
    case msg::OrderResult::RESULT_MALFORMED:
      break;
  }
  return "the coordinator takes it for malformed";
}

std::string order_name(const Order& order) {
  static constexpr const char* kNames[] = {"go", "cancel", "hold", "resume", "zone", "remove zone"};
  const char* const name = kNames[static_cast<std::size_t>(order.kind)];
  return order.robot == kAllRobots ? fmt::format("{} all", name) : fmt::format("{} {}", name, order.robot);
}

std::string client_name(ClientId client) {
  switch (rank_of(client)) {
    case Rank::kOperator:
      return "operator";
    case Rank::kReferee:
      return "referee";
    case Rank::kScenario:
      return "scenario";
    case Rank::kClient:
      break;
  }
  return std::to_string(client);
}

std::string state_text(const msg::OrderStatus& status) {
  static constexpr const char* kStates[] = {"accepted", "driving", "blocked", "arrived", "left"};
  if (status.is_held()) return "held";
  if (status.order_number() == 0) return "no order";
  return is_enumerator(status.order_state(), msg::OrderState::ORDER_LEFT)
             ? kStates[static_cast<std::size_t>(status.order_state())]
             : "?";
}

}  // namespace

std::string to_line(const SentOrder& sent) {
  std::string line = fmt::format("{}: {}", order_name(sent.order), phase_text(sent.phase));
  if (sent.phase == OrderPhase::kRefused) line += fmt::format(", {}", refusal_text(sent.refusal));
  if (sent.phase == OrderPhase::kDriving)
    line += fmt::format(" to goal {} of {}", sent.goal_index + 1, sent.order.goals.size());
  return line;
}

std::string to_table(const std::map<RobotId, msg::OrderStatus>& statuses) {
  std::string table = fmt::format("{:>5}  {:<9} {:<10} {:>4}\n", "robot", "state", "ordered by", "goal");
  for (const auto& [robot, status] : statuses) {
    const bool has_order = status.order_number() != 0;
    table += fmt::format("{:>5}  {:<9} {:<10} {:>4}\n", robot, state_text(status),
                         has_order ? client_name(status.client()) : "-",
                         has_order ? std::to_string(status.pose_index() + 1) : "-");
  }
  return table;
}

}  // namespace sidestep
