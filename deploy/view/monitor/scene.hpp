// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "common/config/scenario.hpp"
#include "common/map/occupancy_map.hpp"

namespace sidestep {

/// The data for the page that does not change during a run: field, obstacles, robots, limits, and the
/// frame_layout(). If `scenario` is nullptr, it is unknown, and robots have the default radius.
[[nodiscard]] nlohmann::ordered_json scene_json(const Scenario* scenario);

/// The cells of a map for the page: one bit per cell, 1 for blocked, in rows from the bottom, each padded to
/// a byte; the first cell is the lowest bit.
[[nodiscard]] std::string map_bits(const OccupancyMap& map);

}  // namespace sidestep
