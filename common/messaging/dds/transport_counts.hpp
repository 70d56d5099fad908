// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

namespace sidestep {

/// Datagrams that a participant's transport has dropped; counted by the threads of Fast DDS.
struct TransportCounts {
  std::atomic<std::uint64_t> impaired{0};    ///< lost by injected network faults
  std::atomic<std::uint64_t> overflowed{0};  ///< found a queue full
  std::atomic<std::uint64_t> malformed{0};   ///< must not be given to Fast DDS, see checked_datagram()
  std::atomic<std::uint64_t> forgotten{0};   ///< of a forgotten participant, see Presence
};

}  // namespace sidestep
