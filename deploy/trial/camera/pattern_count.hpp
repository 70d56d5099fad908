// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/marking/layout.hpp"

namespace sidestep {

/// The number of patterns of c colours on a layout's n dots that identify both robot and heading. Without
/// rotational symmetry these are all c^n patterns. With m symmetries, patterns equal up to a rotation count
/// once, and patterns that are themselves symmetric do not count: sum over d | m of mu(d) c^(n/d), divided by
/// m (for dots on a regular polygon, the aperiodic necklaces; Moreau 1872). Precondition: c^n is below 2^63.
[[nodiscard]] std::uint64_t countable_patterns(const MarkerLayout& layout, std::uint64_t colours);

/// The number of colours in a layout's patterns, without the team colours.
[[nodiscard]] std::uint64_t used_colour_count(const MarkerLayout& layout);

/// The minimum number of dots by which two patterns differ, over all relative headings, or by which a pattern
/// differs from a rotation of itself. If it is 1, one hidden dot can make the identity ambiguous.
[[nodiscard]] std::size_t min_pattern_distance(const MarkerLayout& layout);

}  // namespace sidestep
