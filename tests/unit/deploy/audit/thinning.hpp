// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/unit/deploy/audit/history.hpp"

namespace sidestep {

/// The messages of a history that an auditor on a bad network receives.
struct DegradedHistory {
  std::vector<Delivery> deliveries;  ///< in order of arrival; they point into the history
  std::string losses;                ///< a description of the losses
};

/// Loses messages of a history for a random mixture of causes: independently, in bursts, by topic, sender or
/// robot, all messages for whole seconds, or all before a late start. Also delays messages so that topics
/// overtake each other. Without ground truth, operators' announcements of disturbances are not lost.
DegradedHistory thinned(const MessageHistory& history, std::uint64_t seed);

}  // namespace sidestep
