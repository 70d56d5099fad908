// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/order/order_text.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <set>
#include <string_view>

#include "common/messaging/blockage_text.hpp"
#include "common/messaging/refusal_text.hpp"

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

std::string order_name(const Order& order) {
  static constexpr const char* kNames[] = {"go", "cancel", "hold", "resume", "zone", "remove zone"};
  const char* const name = kNames[static_cast<std::size_t>(order.kind)];
  if (order.kind == msg::OrderKind::ORDER_ZONE || order.kind == msg::OrderKind::ORDER_REMOVE_ZONE)
    return fmt::format("{} {}", name, order.zone_number);
  return order.robot == kAllRobots ? fmt::format("{} all", name) : fmt::format("{} {}", name, order.robot);
}

std::string state_text(const OrderReport& report) {
  static constexpr const char* kStates[] = {"accepted", "driving", "driving", "arrived", "left"};
  if (report.is_held) return "held";
  if (report.number == 0) return "no order";
  if (report.blockage && !report.progress.is_finished()) return "blocked";
  return kStates[static_cast<std::size_t>(report.progress.state)];
}

std::string remaining_text(const OrderReport& report) {
  return report.remaining_s && !report.is_held ? fmt::format("{:.1f}", *report.remaining_s) : "-";
}

}  // namespace

std::string client_text(ClientId client, const ClientName& name) {
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
  const std::string text = to_text(name);
  return "client " + (text.empty() ? std::to_string(client) : text);
}

std::string unknown_zone_text(std::uint32_t number, ClientId client, const ClientName& name,
                              const std::vector<Order>& zones) {
  const auto owner = [](ClientId id, const ClientName& of) {
    return (rank_of(id) == Rank::kClient ? "" : "the ") + client_text(id, of);
  };
  std::set<std::string> known;
  for (const Order& zone : zones)
    known.insert(fmt::format("{} of {}", zone.zone_number, owner(zone.client, zone.client_name)));
  return fmt::format("remove zone {}: refused, {} has no zone {}; {}", number, owner(client, name), number,
                     known.empty() ? "there are no zones" : fmt::format("zones: {}", fmt::join(known, ", ")));
}

std::string to_line(const SentOrder& sent) {
  std::string line = fmt::format("{}: {}", order_name(sent.order), phase_text(sent.phase));
  if (sent.phase == OrderPhase::kRefused) line += fmt::format(", {}", refusal_text(sent.refusal));
  if (sent.phase == OrderPhase::kDriving)
    line += fmt::format(" to goal {} of {}", sent.goal_index + 1, sent.order.goals.size());
  if (sent.phase == OrderPhase::kBlocked && sent.blockage) line += ": " + to_text(*sent.blockage);
  return line;
}

std::string to_table(const std::map<RobotId, OrderReport>& reports) {
  constexpr const char* kHeading = "ordered by";
  const auto owner = [](const OrderReport& report) {
    return report.number != 0 ? client_text(report.client, report.client_name) : std::string("-");
  };
  std::size_t width = std::string_view(kHeading).size();
  for (const auto& [robot, report] : reports) width = std::max(width, owner(report).size());
  std::string table = fmt::format("{:>5}  {:<9} {:<{}} {:>4} {:>6}  {}\n", "robot", "state", kHeading, width,
                                  "goal", "left s", "why");
  for (const auto& [robot, report] : reports) {
    const bool has_order = report.number != 0;
    table += fmt::format("{:>5}  {:<9} {:<{}} {:>4} {:>6}  {}\n", robot, state_text(report), owner(report),
                         width, has_order ? std::to_string(report.progress.goal_index + 1) : "-",
                         remaining_text(report), report.blockage ? to_text(*report.blockage) : "");
  }
  return table;
}

}  // namespace sidestep
