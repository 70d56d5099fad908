// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "idl/order.hpp"

namespace sidestep {

/// Describes why a coordinator has refused an order: "a goal is outside the field". Used by commands and the
/// monitor. Precondition: the result is a refusal.
[[nodiscard]] const char* refusal_text(msg::OrderResult result);

}  // namespace sidestep
