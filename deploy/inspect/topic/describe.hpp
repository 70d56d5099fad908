// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "common/messaging/topics.hpp"

namespace sidestep {

/// A topic's message in readable form. Members are converted by ReadableForm and OctetSequences::kText;
/// fingerprints are in hexadecimal, drop reasons by name, laser beams without a range in words, and
/// histograms as quantiles. Numbers that mean every robot, every process or no robot are "all" and "none".
[[nodiscard]] nlohmann::ordered_json describe(const TopicInfo& topic, const void* message);

}  // namespace sidestep
