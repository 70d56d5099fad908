// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/grids/navigation/estar.hpp"
#include "common/geometry/segment.hpp"

namespace sidestep {

/// Where a field's values are multiples of a spacing (marching squares between the centres of four reached
/// cells), for pictures. Throws std::invalid_argument for a spacing that is not positive.
[[nodiscard]] std::vector<Segment> iso_lines(const EStar& field, double spacing_cells);

}  // namespace sidestep
