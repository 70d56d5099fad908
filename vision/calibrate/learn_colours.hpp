// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/image/image.hpp"
#include "vision/calibrate/floor_labels.hpp"
#include "vision/colours/colour_file.hpp"

namespace sidestep {

struct LabelledImage {
  ImageView image;
  FloorLabels labels;
};

struct LearnedColour {
  Colour colour{};
  std::uint64_t pixels = 0;  ///< number of pixels labelled with this colour
  double recall = 0;         ///< fraction of these pixels that the thresholds classify as this colour
};

struct LearnedColours {
  ColourThresholds thresholds;
  std::vector<LearnedColour> colours;  ///< one element per expected colour
  double ground_false_positives = 0;   ///< fraction of the background classified as a named colour
  std::vector<std::string> warnings;   ///< for the user: reasons why the data are unsuitable for calibration
};

/// Learns thresholds from labelled images, and evaluates them on the same images. `expected` are the colours
/// that the images should show. Precondition: at least one image, all of one format.
[[nodiscard]] LearnedColours learn_colours(std::span<const LabelledImage> images,
                                           std::span<const Colour> expected);

}  // namespace sidestep
