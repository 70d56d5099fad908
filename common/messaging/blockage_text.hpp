// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/protocol/order.hpp"

namespace sidestep {

/// What keeps a robot from its goal, and where it goes instead, as a clause: "robot 5 stands on its goal; it
/// goes to 1.20,-0.40 instead". Commands, reports and the monitor's page use it.
[[nodiscard]] std::string to_text(const Blockage& blockage);

}  // namespace sidestep
