// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace sidestep {

/// Draws the run of a report (to_json()) as an SVG that plays in a browser: starts, goals, the paths of the
/// robots with their directions, contacts, obstacles and opponents, with coordinates, scale and legend. If
/// the report has no paths, the picture says so. Throws std::invalid_argument if the report is damaged.
[[nodiscard]] std::string run_picture(const nlohmann::ordered_json& report);
/// Draws the run of a report that is given as text.
[[nodiscard]] std::string run_picture_from(std::string_view report_text);

/// "crossing, seed 7", and how the run ended in one line: "passed: 8 of 8 robots arrived in 3.01 s".
[[nodiscard]] std::string run_title(const nlohmann::ordered_json& report);
[[nodiscard]] std::string run_outcome(const nlohmann::ordered_json& report);

}  // namespace sidestep
