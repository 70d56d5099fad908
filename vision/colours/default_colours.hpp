// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/marking/butterfly.hpp"
#include "common/marking/layout.hpp"
#include "vision/colours/colour_file.hpp"

namespace sidestep {

/// Thresholds for those who have no file: what a ColourLearner makes of the colours by name
/// (common/marking/colours.hpp), as they are in full light down to 55 % of it, with a sensor's noise. Known
/// are the colours that the layout wears and the ball's; the ground is carpet, white and black.
ColourThresholds default_colours(PixelFormat format, const MarkingLayout& layout = butterfly());

}  // namespace sidestep
