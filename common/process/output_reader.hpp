// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/messaging/dds/bus.hpp"

namespace sidestep {

/// How often a command that waits for something to print checks whether anybody still reads its output.
inline constexpr Duration kReaderPeriod = std::chrono::milliseconds(500);

/// Stops the bus soon after the reader of stdout has ended; see is_output_abandoned().
void stop_without_reader(DdsBus& bus);

}  // namespace sidestep
