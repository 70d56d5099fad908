// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/order/order_text.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <set>
#include <string_view>

#include "common/messaging/blockage_text.hpp"
#include "common/messaging/refusal_text.hpp"
#include "common/protocol/client_text.hpp"

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

/// A line of the table of robots.
struct TableRow {
  std::string state, owner = "-", goal = "-", remaining = "-", why;
};

TableRow row_of(const OrderReport& report, const std::vector<Hindrance>& hindrances) {
  TableRow row;
  row.state = hindrances.empty() ? state_text(report) : hindrances.front().state;
  if (report.number != 0) {
    row.owner = client_text(report.client, report.client_name);
    row.goal = std::to_string(report.progress.goal_index + 1);
  }
  if (report.remaining_s && !report.is_held && hindrances.empty())
    row.remaining = fmt::format("{:.1f}", *report.remaining_s);
  row.why = to_text(hindrances);
  if (report.blockage) row.why += (row.why.empty() ? "" : "; ") + to_text(*report.blockage);
  return row;
}

}  // namespace

std::string held_text(const std::vector<Order>& holds) {
  std::set<std::string> owners;
  for (const Order& hold : holds) owners.insert(client_phrase(hold.client, hold.client_name));
  return owners.empty() ? "it is held" : fmt::format("it is held by {}", fmt::join(owners, " and "));
}

std::string still_held_text(const std::vector<Order>& holds) {
  std::map<std::string, std::set<RobotId>> robots_of;
  for (const Order& hold : holds) robots_of[client_phrase(hold.client, hold.client_name)].insert(hold.robot);
  std::vector<std::string> parts;
  for (const auto& [owner, robots] : robots_of) {
    const bool is_for_all = robots.contains(kAllRobots);
    parts.push_back(is_for_all ? fmt::format("all robots by {}", owner)
                               : fmt::format("robot{} {} by {}", robots.size() > 1 ? "s" : "",
                                             fmt::join(robots, ", "), owner));
  }
  return fmt::format("still held: {}; a hold is ended by its client or by the operator",
                     fmt::join(parts, ", and "));
}

std::string to_line(const SentOrder& sent, const std::vector<Hindrance>& hindrances) {
  if (!hindrances.empty() && !is_final(sent.phase))
    return fmt::format("{}: not driving: {}", order_name(sent.order), to_text(hindrances));
  std::string line = fmt::format("{}: {}", order_name(sent.order), phase_text(sent.phase));
  if (sent.phase == OrderPhase::kRefused) line += fmt::format(", {}", refusal_text(sent.refusal));
  if (sent.phase == OrderPhase::kDriving)
    line += fmt::format(" to goal {} of {}", sent.goal_index + 1, sent.order.goals.size());
  if (sent.phase == OrderPhase::kBlocked && sent.blockage) line += ": " + to_text(*sent.blockage);
  return line;
}

std::string open_orders_text(const std::set<RobotId>& driving, const std::set<RobotId>& waiting,
                             const std::string& client) {
  const auto robots = [](const std::set<RobotId>& ids) {
    return fmt::format("robot{} {}", ids.size() > 1 ? "s" : "", fmt::join(ids, ", "));
  };
  std::vector<std::string> parts;
  if (!driving.empty()) parts.push_back(robots(driving) + (driving.size() > 1 ? " drive on" : " drives on"));
  if (!waiting.empty()) {
    parts.push_back(fmt::format("the order{} of {}", waiting.size() > 1 ? "s" : "", robots(waiting)) +
                    (waiting.size() > 1 ? " stay in force" : " stays in force"));
  }
  if (parts.empty()) return "";
  const bool is_one = driving.size() + waiting.size() == 1;
  const std::string robot = is_one ? std::to_string(*(driving.empty() ? waiting : driving).begin()) : "ROBOT";
  return fmt::format("{}; `sidestep cancel {}{}` ends {}", fmt::join(parts, ", and "), robot,
                     client.empty() ? "" : " --client " + client, is_one ? "it" : "an order");
}

std::string to_table(const std::map<RobotId, OrderReport>& reports,
                     const std::map<RobotId, std::vector<Hindrance>>& hindrances) {
  constexpr const char* kHeading = "ordered by";
  std::map<RobotId, TableRow> rows;
  std::size_t width = std::string_view(kHeading).size();
  for (const auto& [robot, report] : reports) {
    const auto found = hindrances.find(robot);
    rows[robot] = row_of(report, found == hindrances.end() ? std::vector<Hindrance>() : found->second);
    width = std::max(width, rows[robot].owner.size());
  }
  std::string table = fmt::format("{:>5}  {:<9} {:<{}} {:>4} {:>6}  {}\n", "robot", "state", kHeading, width,
                                  "goal", "left s", "why");
  for (const auto& [robot, row] : rows)
    table += fmt::format("{:>5}  {:<9} {:<{}} {:>4} {:>6}  {}\n", robot, row.state, row.owner, width,
                         row.goal, row.remaining, row.why);
  return table;
}

}  // namespace sidestep
