// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace sidestep {

/// A page about the run of a report, for a browser: verdict, key figures, the picture of the paths, which
/// plays, speeds, arrivals, latencies, events and counters. It needs no other file and no network. Throws
/// std::invalid_argument, with the reason, if the report is not one of a run.
[[nodiscard]] std::string report_page(const nlohmann::ordered_json& report);

/// The same in a few lines for a terminal: verdict and events.
[[nodiscard]] std::string report_text(const nlohmann::ordered_json& report);

}  // namespace sidestep
