// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <nlohmann/json_fwd.hpp>

#include "common/time/time.hpp"
#include "deploy/view/monitor/history.hpp"

namespace sidestep {

/// Length of the trails that the page draws.
inline constexpr Duration kTrail = std::chrono::seconds(5);

/// Where the robots were in the last kTrail before a time, as far as the history knows:
/// {"robots": [{"id": 3, "points": [[at_s, x_m, y_m], …]}, …]}, sorted by time. The points of large fleets
/// are further apart.
[[nodiscard]] nlohmann::ordered_json trails_json(const History& history, Time at);

}  // namespace sidestep
