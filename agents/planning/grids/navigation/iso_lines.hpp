// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/grids/navigation/estar.hpp"
#include "common/geometry/segment.hpp"

namespace sidestep {

/// The lines on which a field's values are multiples of a spacing, for pictures (marching squares between the
/// centres of four reached cells). Throws std::invalid_argument if the spacing is not positive.
[[nodiscard]] std::vector<Segment> iso_lines(const EStar& field, double spacing_cells);

}  // namespace sidestep
