// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "common/client/order_client.hpp"
#include "deploy/run/order/hindrance.hpp"

namespace sidestep {

/// One line that describes the state of an order, or says what hinders its robot: "go 3: not driving: it is
/// off the floor".
[[nodiscard]] std::string to_line(const SentOrder& sent, const std::vector<Hindrance>& hindrances = {});

/// Who holds a robot: "it is held by client bob and the operator". "it is held" if no hold is known.
[[nodiscard]] std::string held_text(const std::vector<Order>& holds);

/// Which robots are still held after a resume, by whom, and who can resume them.
[[nodiscard]] std::string still_held_text(const std::vector<Order>& holds);

/// What becomes of orders for which nobody waits any longer, and how to end them. `waiting` are robots that
/// do not drive; `client` is empty for the operator. Empty without robots.
[[nodiscard]] std::string open_orders_text(const std::set<RobotId>& driving, const std::set<RobotId>& waiting,
                                           const std::string& client);

/// A table of the robots' activities, with one line per robot.
[[nodiscard]] std::string to_table(const std::map<RobotId, OrderReport>& reports,
                                   const std::map<RobotId, std::vector<Hindrance>>& hindrances);

}  // namespace sidestep
