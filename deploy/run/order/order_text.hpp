// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/client/order_client.hpp"

namespace sidestep {

/// One line that describes the state of an order.
[[nodiscard]] std::string to_line(const SentOrder& sent);

/// The client in words: "operator", "referee", "scenario" or "client kitchen"; if it has no name, "client
/// 2936412733".
[[nodiscard]] std::string client_text(ClientId client, const ClientName& name);

/// Why a zone cannot be removed that none of the remembered zones is, and which zones there are.
[[nodiscard]] std::string unknown_zone_text(std::uint32_t number, ClientId client, const ClientName& name,
                                            const std::vector<Order>& zones);

/// A table of the robots' activities, with one line per robot.
[[nodiscard]] std::string to_table(const std::map<RobotId, OrderReport>& reports);

}  // namespace sidestep
