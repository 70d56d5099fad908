// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/protocol/senders.hpp"

namespace sidestep {

/// The process, or all processes, that a network fault applies to.
struct FaultTarget {
  std::uint32_t number = kEveryProcess;  ///< as in NetworkFault.target
  std::string participant;               ///< name of the DDS participant; empty: every process
};

/// Parses "all", "agent 3", "coordinator", "coordinator 1", "vision" or "simulator"; nullopt for anything
/// else.
[[nodiscard]] std::optional<FaultTarget> parse_fault_target(const std::string& text);

}  // namespace sidestep
