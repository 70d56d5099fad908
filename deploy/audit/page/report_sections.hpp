// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "deploy/audit/metrics/floor_trace.hpp"

namespace sidestep {

// Sections of a report's page, as HTML.

/// Arrivals, contacts, clearance, times, and what the audit covered.
[[nodiscard]] std::string figures_section(const nlohmann::ordered_json& report);
/// The robots' speeds over time.
[[nodiscard]] std::string speeds_section(const FloorTrace& trace);
/// When each robot arrived; of many robots, how many had arrived.
[[nodiscard]] std::string arrivals_section(const nlohmann::ordered_json& report);
[[nodiscard]] std::string latencies_section(const nlohmann::ordered_json& report);
[[nodiscard]] std::string events_section(const nlohmann::ordered_json& report);
/// What processes dropped, and what they used; empty if the report says nothing of it.
[[nodiscard]] std::string processes_section(const nlohmann::ordered_json& report);

/// A section with a heading, which is not escaped yet.
[[nodiscard]] std::string html_section(const std::string& heading, const std::string& content);

}  // namespace sidestep
