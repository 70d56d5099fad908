// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "common/messaging/topics.hpp"

namespace sidestep {

/// The readable form of a message of a topic: the members of its IDL, changed as ReadableForm and
/// OctetSequences::kText say, fingerprints in hexadecimal, drop reasons by name, beams without a range in
/// words, and histograms as quantiles.
[[nodiscard]] nlohmann::ordered_json describe(const TopicInfo& topic, const void* message);

}  // namespace sidestep
