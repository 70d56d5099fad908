// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace sidestep {

/// Number of ports per peer address at which a process looks for others. It limits the participants on one
/// host that find each other without multicast.
inline constexpr std::uint32_t kPortsPerPeer = 40;

/// Whether a locator is for discovery. Ports are 7400 + 250 domain + an offset: 0 and 10 + 2 i for discovery,
/// 1 and 11 + 2 i for messages (RTPS 2.2, 9.6.1).
template <typename Locator>
bool is_discovery(const Locator& locator) {
  return locator.port % 2 == 0;
}

/// Whether a discovery datagram is addressed to all participants: to a multicast address, or to all ports at
/// which peers may be.
template <typename Locators>
bool is_for_all_participants(Locators& destinations) {
  constexpr std::uint8_t kFirst = 224, kLast = 239;  // first byte of multicast addresses
  std::size_t count = 0;
  for (const auto& destination : destinations) {
    ++count;
    if (destination.address[12] >= kFirst && destination.address[12] <= kLast) return true;
  }
  return count >= kPortsPerPeer;
}

}  // namespace sidestep
