// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/messaging/dds/listener.hpp"

namespace sidestep {

/// Why nothing of a topic has been printed, in one line: nobody writes it, its writers have sent nothing, or
/// none of the `received` messages passed the filters.
[[nodiscard]] std::string silence_text(const std::string& topic, int domain,
                                       const std::vector<DiscoveredEndpoint>& endpoints,
                                       std::uint64_t received);

/// The same for a recording with messages on these channels.
[[nodiscard]] std::string silence_text(const std::string& topic, const std::string& recording,
                                       const std::vector<std::string>& channels, std::uint64_t received);

}  // namespace sidestep
