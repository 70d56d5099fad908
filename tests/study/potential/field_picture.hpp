// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tests/study/potential/field_drive.hpp"

namespace sidestep {

struct PicturePath {
  std::vector<Vec2> path_m;
  std::string colour, title;
};

/// Draws a world as SVG with the directions of a field, and driven paths with a legend.
[[nodiscard]] std::string field_picture(const PlanWorld& world, const DriveDirection& field,
                                        const std::vector<PicturePath>& paths);

}  // namespace sidestep
