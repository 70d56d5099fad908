// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <utility>
#include <vector>

#include "common/messaging/order_codec.hpp"
#include "common/protocol/order_book.hpp"

namespace sidestep {

/// Holds that a client has not been told of yet. A hold is confirmed once the agent of a robot that it holds
/// has reported to be held, and the robot after that to obey this coordinator: then another process remembers
/// the hold, and has not registered with a later coordinator before it did. So a coordinator that takes over
/// learns of it although this one may have been cut off. As long as no such agent lives, the client gets no
/// answer, and repeats the hold, also to the next coordinator.
class HoldConfirmations {
 public:
  /// A hold that stands in the book of orders. It replaces an earlier one of its client and robot.
  void add(const Order& hold);
  void on_report(const OrderReport& report);
  /// A fact of a robot that obeys this coordinator's epoch.
  void on_obeyed(RobotId robot);
  /// The holds that are confirmed, and those that stand in the book no more; each once.
  std::vector<Order> take_confirmed(const OrderBook& book);
  void clear() { waiting_.clear(); }
  bool is_waiting() const { return !waiting_.empty(); }

 private:
  struct Waiting {
    Order hold;
    std::set<RobotId> remembered_by{};  // agents of robots of the roster
    bool is_confirmed = false;
  };

  std::map<std::pair<ClientId, RobotId>, Waiting> waiting_;
};

}  // namespace sidestep
