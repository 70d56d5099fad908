// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/config/scenario.hpp"

namespace sidestep {

inline constexpr double kPixelsPerMetre = 200;

/// The beginning of an SVG picture: the field with obstacles and the map. SVG's y axis points down.
[[nodiscard]] std::string svg_floor(const Scenario& scenario);
[[nodiscard]] const char* colour_of(Team team);
/// Draws a robot with its number.
[[nodiscard]] std::string svg_robot(const Scenario& scenario, const RobotSpec& robot, const Vec2& at_m);

}  // namespace sidestep
