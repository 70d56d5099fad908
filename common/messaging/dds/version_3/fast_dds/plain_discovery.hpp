// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace sidestep::fast_dds {

/// The entity ids of a writer and of its readers.
struct DiscoveryPair {
  std::uint32_t writer, reader;
};

/// The discovery writers whose messages Fast DDS 3 sends unencrypted. They announce participants, writers,
/// readers and liveliness (RTPS 2.2, 9.3.1.2). With keys, one more announces participants to authenticated
/// participants (DDS Security 1.1, 7.4.4).
constexpr std::array<DiscoveryPair, 5> kPlainDiscovery{{{0x000100c2, 0x000100c7},
                                                        {0x000003c2, 0x000003c7},
                                                        {0x000004c2, 0x000004c7},
                                                        {0x000200c2, 0x000200c7},
                                                        {0xff0101c2, 0xff0101c7}}};

}  // namespace sidestep::fast_dds
