// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/protocol/senders.hpp"

namespace sidestep {

/// The process, or all processes, that a network fault applies to.
struct FaultTarget {
  std::uint32_t number = kEveryProcess;  ///< as in NetworkFault.target
  std::string participant;               ///< name of the DDS participant; empty: every process
};

/// Parses "all", "agent 3", "coordinator", "coordinator 1", "vision", "simulator" or "robots"; nullopt for
/// anything else.
[[nodiscard]] std::optional<FaultTarget> parse_fault_target(const std::string& text);

/// The participants among these subscribers to faults that apply them. Observers, for example a monitor or a
/// recorder, read faults too, but apply none.
[[nodiscard]] std::vector<std::string> without_observers(std::vector<std::string> subscribers);

}  // namespace sidestep
