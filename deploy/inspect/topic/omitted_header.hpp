// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "deploy/inspect/topic/idl/idl_type.hpp"
#include "idl/header.hpp"

namespace sidestep {

/// Why all processes would refuse the message; empty if they would not. An omitted sender is the operator,
/// whose messages they accept on some of our topics only. `channel` is the DDS topic name.
[[nodiscard]] std::string sender_problem(const IdlType& type, const nlohmann::ordered_json& message,
                                         const std::string& channel);

/// The message with those members of its `header` taken from the given one that it omits, except the rules,
/// which an operator does not have. Messages of types without our header are returned unchanged.
[[nodiscard]] nlohmann::ordered_json with_header(const IdlType& type, nlohmann::ordered_json message,
                                                 const msg::Header& header);

}  // namespace sidestep
