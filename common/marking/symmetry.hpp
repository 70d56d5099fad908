// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/marking/layout.hpp"

namespace sidestep {

/// A turn about the centre dot that puts every dot where one of the same size was.
struct DotTurn {
  double angle_rad = 0;
  std::vector<std::size_t> goes_to;  ///< for each dot
};

/// Dots closer than this stand on one spot.
inline constexpr double kSameSpot_m = 0.001;

/// All turns of a layout's dots, regardless of their colours, by ascending angle; the first is none at all.
/// They are multiples of one angle: a full turn over their number. Precondition: no dot overlaps another or
/// the centre.
std::vector<DotTurn> turns_of(const MarkingLayout& layout);

/// In how many dots a pattern differs from another one that is turned.
std::size_t differences(const std::vector<Colour>& pattern, const std::vector<Colour>& turned,
                        const DotTurn& turn);

}  // namespace sidestep
