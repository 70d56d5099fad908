// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

namespace sidestep {

/// Datagrams that a participant's transport has dropped; counted by the threads of Fast DDS.
struct TransportCounts {
  std::atomic<std::uint64_t> impaired{0};    ///< lost by injected network faults
  std::atomic<std::uint64_t> overflowed{0};  ///< dropped because a queue was full
  std::atomic<std::uint64_t> malformed{0};   ///< refused by checked_datagram()
  std::atomic<std::uint64_t> forgotten{0};   ///< sent by a forgotten participant, see Presence
};

}  // namespace sidestep
