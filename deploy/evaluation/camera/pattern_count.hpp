// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/marking/layout.hpp"

namespace sidestep {

/// How many patterns of so many colours a layout's dots can show such that each tells id and heading. All c^n
/// where no turn puts the dots on each other. Where m turns do, patterns that look the same when turned count
/// once, and those that look like themselves not at all: sum over d | m of mu(d) c^(n/d), over m (for dots on
/// a regular polygon, the aperiodic necklaces; Moreau 1872). Precondition: c^n is below 2^63.
std::uint64_t countable_patterns(const MarkingLayout& layout, std::uint64_t colours);

/// How many colours a layout's patterns use, the teams' aside.
std::uint64_t used_colours(const MarkingLayout& layout);

/// In how many dots the two most alike patterns differ, whatever the headings, and a pattern from itself when
/// turned. With 1, a hidden dot may leave the id open.
std::size_t smallest_difference(const MarkingLayout& layout);

}  // namespace sidestep
