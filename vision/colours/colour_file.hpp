// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/image/image.hpp"
#include "vision/segmentation/colour_classes.hpp"

namespace sidestep {

/// By what numbers colours are told in frames of one format.
struct ColourThresholds {
  PixelFormat format = PixelFormat::kYuv422;
  std::vector<ColourBox> boxes;  ///< of Colours, by their numbers, and of kOtherColour
};

/// Reads and checks a file of thresholds; throws ScenarioError ("FILE:LINE: ...") for anything that is wrong.
/// The numbers are pixel_at()'s; where boxes overlap the first one counts, and a colour may have several.
/// ```
/// format: yuv422                                          # or rgb
/// boxes:
///   - {colour: orange, low: [98, 0, 166], high: [255, 94, 255]}
///   - {colour: other, low: [0, 150, 0], high: [255, 255, 255]}   # what nobody named
/// ```
ColourThresholds load_colours(const std::string& path);
/// The same from text; `file_name` stands in messages.
ColourThresholds parse_colours(const std::string& text, const std::string& file_name);
/// What parse_colours() reads back.
std::string colours_text(const ColourThresholds& thresholds);

}  // namespace sidestep
