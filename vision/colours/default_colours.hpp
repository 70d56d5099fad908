// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/marking/butterfly.hpp"
#include "common/marking/layout.hpp"
#include "vision/colours/colour_file.hpp"

namespace sidestep {

/// Thresholds for use without a file, for the colours of the layout and the ball. A ColourLearner learns them
/// from the named colours (common/marking/colours.hpp) between full light and 55 % of it, with sensor noise.
/// The ground consists of the field surface, white and black.
[[nodiscard]] ColourThresholds default_colours(PixelFormat format, const MarkerLayout& layout = butterfly());

}  // namespace sidestep
