// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/image/image.hpp"
#include "vision/segmentation/colour_classes.hpp"

namespace sidestep {

/// Thresholds that classify the colours in frames of one format.
struct ColourThresholds {
  PixelFormat format = PixelFormat::kYuv422;
  std::vector<ColourBox> boxes;  ///< colour numbers: those of Colour, or kOtherColour
};

/// Reads and validates a file of thresholds; throws ConfigError ("FILE:LINE: ...") for any error. The limits
/// of a box apply to the values that pixel_at() returns. Where boxes overlap, the first one wins. A colour
/// may have several boxes.
/// ```
/// format: yuv422                                          # or rgb
/// boxes:
///   - {colour: orange, low: [98, 0, 166], high: [255, 94, 255]}
///   - {colour: other, low: [0, 150, 0], high: [255, 255, 255]}   # any colour without a name
/// ```
[[nodiscard]] ColourThresholds load_colours(const std::string& path);
/// Parses and checks the text of a file of thresholds; `file_name` appears in error messages.
[[nodiscard]] ColourThresholds parse_colours(const std::string& text, const std::string& file_name);
/// The text of a file that parse_colours() can read.
[[nodiscard]] std::string colours_text(const ColourThresholds& thresholds);

}  // namespace sidestep
