// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "common/time/time.hpp"
#include "deploy/inspect/floor/floor_state.hpp"
#include "deploy/view/monitor/closest_pair.hpp"
#include "deploy/view/monitor/waits.hpp"

namespace sidestep {

/// A picture of the floor at one time, in a form that a browser reads without decoding: a header, and then
/// rows of 32-bit floats, all little-endian.
///
/// | bytes | |
/// |---|---|
/// | 8 | time, seconds since 1970, double |
/// | 4 × (1 + sections) | number of sections, number of rows in each, unsigned |
/// | 4 × … | the rows of each section |
///
/// frame_layout() names the sections and the columns of their rows. Unknown values are NaN.
[[nodiscard]] std::string encode_frame(const FloorState& floor, const Waits& waits, Time now);

/// The robots of a frame whose positions are known: from ground truth, else from vision, else from the
/// robots' own estimates.
[[nodiscard]] std::vector<RobotPlace> places_in(const std::string& frame);

/// {"sections": [{"name": "robots", "columns": ["id", …]}, …], "flags": ["off_reference", …]}. The flags are
/// the bits of the column "flags", starting with the lowest.
[[nodiscard]] nlohmann::ordered_json frame_layout();

}  // namespace sidestep
