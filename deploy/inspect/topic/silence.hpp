// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/messaging/dds/bus.hpp"
#include "common/messaging/dds/listener.hpp"
#include "deploy/inspect/topic/topic_tools.hpp"

namespace sidestep {

/// Why nothing of a topic has been received or printed, in one line: nobody writes it, its writers have sent
/// nothing, or none of the `received` messages passed the filters.
[[nodiscard]] std::string silence_text(const std::string& topic, int domain,
                                       const std::vector<DiscoveredEndpoint>& endpoints,
                                       std::uint64_t received);

/// The same for a recording with messages on these channels.
[[nodiscard]] std::string silence_text(const std::string& topic, const std::string& recording,
                                       const std::vector<std::string>& channels, std::uint64_t received);

/// The same for a recording whose channels are read from the file. Throws std::runtime_error if that fails.
[[nodiscard]] std::string recorded_silence_text(const std::string& topic, const std::string& recording_file,
                                                std::uint64_t received);

/// Runs the bus until writers would have been discovered. If it is silent until then, runs it as long again,
/// and says on stderr why it is silent. `received`: the number of messages received. The command will go on
/// until `end`.
void explain_silence(DdsBus& bus, const TopicOptions& options, const std::function<bool()>& is_silent,
                     const std::function<std::uint64_t()>& received, Time end);

/// What a view of all endpoints says if there is none.
[[nodiscard]] std::string empty_domain_text(int domain);

}  // namespace sidestep
