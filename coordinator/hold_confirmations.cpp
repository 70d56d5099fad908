// SPDX-License-Identifier: Apache-2.0
#include "coordinator/hold_confirmations.hpp"

namespace sidestep {

void HoldConfirmations::add(const Order& hold) {
  const auto [entry, is_new] = waiting_.try_emplace({hold.client, hold.robot}, Waiting{hold});
  if (!is_new && entry->second.hold.number != hold.number) entry->second = {hold};
}

void HoldConfirmations::on_report(const OrderReport& report) {
  if (!report.is_held) return;
  for (auto& [key, waiting] : waiting_) {
    if (waiting.hold.robot == kAllRobots || waiting.hold.robot == report.robot)
      waiting.remembered_by.insert(report.robot);
  }
}

void HoldConfirmations::on_obeyed(RobotId robot) {
  for (auto& [key, waiting] : waiting_) waiting.is_confirmed |= waiting.remembered_by.contains(robot);
}

std::vector<Order> HoldConfirmations::take_confirmed(const OrderBook& book) {
  std::vector<Order> confirmed;
  std::erase_if(waiting_, [&](const auto& entry) {
    if (book.stands(entry.second.hold) && !entry.second.is_confirmed) return false;
    confirmed.push_back(entry.second.hold);
    return true;
  });
  return confirmed;
}

}  // namespace sidestep
