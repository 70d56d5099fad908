// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "deploy/audit/metrics/floor_trace.hpp"

namespace sidestep {

/// Adds the keys floor, paths and incidents to a report.
void add_floor_trace(nlohmann::ordered_json& report, const FloorTrace& trace);

/// The trace in a report; nullopt if the report has none. Throws std::invalid_argument, with the reason, if
/// it is damaged.
[[nodiscard]] std::optional<FloorTrace> floor_trace_of(const nlohmann::ordered_json& report);

}  // namespace sidestep
