// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/protocol/order.hpp"

namespace sidestep {

/// The client in words: "operator", "referee", "scenario", "coordinator 0" or "client kitchen"; if it has no
/// name, "client 2936412733".
[[nodiscard]] std::string client_text(ClientId client, const ClientName& name);

/// The client as a part of a sentence: "the operator", "client kitchen".
[[nodiscard]] std::string client_phrase(ClientId client, const ClientName& name);

/// Why a zone cannot be removed that none of the remembered zones is, and which zones there are.
[[nodiscard]] std::string unknown_zone_text(std::uint32_t number, ClientId client, const ClientName& name,
                                            const std::vector<Order>& zones);

}  // namespace sidestep
