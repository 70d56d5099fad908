// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "common/client/order_client.hpp"

namespace sidestep {

/// One line that describes the state of an order.
[[nodiscard]] std::string to_line(const SentOrder& sent);

/// A table of the robots' activities, with one line per robot.
[[nodiscard]] std::string to_table(const std::map<RobotId, OrderReport>& reports);

}  // namespace sidestep
