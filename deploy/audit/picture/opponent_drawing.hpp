// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/svg/floor_view.hpp"
#include "deploy/audit/metrics/floor_trace.hpp"
#include "deploy/audit/picture/run_timing.hpp"

namespace sidestep {

/// Where an opponent is from `from_s` to `to_s` after it began to move: at these times, at every corner in
/// between, and on straight lines between them. The times of corners beyond a limit are left out.
[[nodiscard]] std::vector<FloorTrace::Point> opponent_path(const OpponentSpec& opponent, double from_s,
                                                           double to_s);

/// Draws the opponents and their paths, which do not depend on the robots.
[[nodiscard]] std::string svg_opponents(const FloorTrace& trace, const FloorView& view,
                                        const RunTiming& timing);

inline constexpr const char* kOpponentColour = "#a40e26";

}  // namespace sidestep
