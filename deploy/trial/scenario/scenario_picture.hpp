// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/config/scenario.hpp"

namespace sidestep {

/// An SVG picture of a scenario: its obstacles, the robots at their starts with their directions, lines to
/// their goals in order, and the paths of moving obstacles, with coordinates, scale and legend.
[[nodiscard]] std::string scenario_picture(const Scenario& scenario);

}  // namespace sidestep
