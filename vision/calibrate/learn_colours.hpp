// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/image/image.hpp"
#include "vision/calibrate/known_floor.hpp"
#include "vision/colours/colour_file.hpp"

namespace sidestep {

struct KnownImage {
  ImageView image;
  KnownFloor floor;
};

struct LearnedColour {
  Colour colour{};
  std::uint64_t pixels = 0;  ///< that were learned from
  double told = 0;           ///< share of them that the thresholds call by this name
};

struct LearnedColours {
  ColourThresholds thresholds;
  std::vector<LearnedColour> colours;  ///< those that were expected
  double ground_named = 0;  ///< share of the background that the thresholds take for something named
  std::vector<std::string> warnings;  ///< what calibrates badly, for people
};

/// Learns thresholds from images in which is known what stands where, and looks whether they tell what was
/// learned. `expected` are the colours that were to be seen. Precondition: at least one image, all of one
/// format.
LearnedColours learn_colours(std::span<const KnownImage> images, std::span<const Colour> expected);

}  // namespace sidestep
