// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/protocol/order.hpp"

namespace sidestep {

/// Describes why a robot cannot reach its goal, and where it goes instead: "robot 5 stands on its goal; it
/// goes to 1.20,-0.40 instead", "a stranger 0.25 m away, who may move at 1.5 m/s". Used by commands, reports
/// and the monitor's page.
[[nodiscard]] std::string to_text(const Blockage& blockage);

}  // namespace sidestep
