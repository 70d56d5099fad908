// SPDX-License-Identifier: Apache-2.0
#include "vision/calibrate/learn_colours.hpp"

#include <array>
#include <fmt/format.h>

#include "vision/colours/known_pixels.hpp"
#include "vision/segmentation/colour_classes.hpp"

namespace sidestep {
namespace {

constexpr std::uint64_t kFewPixels = 30;
constexpr double kLeastTold = 0.95;
constexpr double kMostGround = 0.002;  // a dot's worth of pixels in a frame is less

bool overlap(const ColourBox& a, const ColourBox& b) {
  const auto meet = [](std::uint8_t al, std::uint8_t ah, std::uint8_t bl, std::uint8_t bh) {
    return al <= bh && bl <= ah;
  };
  return meet(a.low.y, a.high.y, b.low.y, b.high.y) && meet(a.low.u, a.high.u, b.low.u, b.high.u) &&
         meet(a.low.v, a.high.v, b.low.v, b.high.v);
}

/// How the thresholds tell what they were learned from.
struct Tally {
  std::array<std::uint64_t, kColours.size()> pixels{}, told{};
  std::uint64_t ground = 0, named = 0;

  void add(const KnownImage& known, const ColourClasses& classes) {
    const auto colour_at = [&](int x, int y) { return classes.colour_of(pixel_at(known.image, x, y)); };
    for_known_pixels(
        known.image, known.floor.discs, known.floor.unknown,
        [&](const KnownDisc& disc, int x, int y) {
          const auto own = static_cast<std::size_t>(disc.colour);
          ++pixels[own];
          told[own] += colour_at(x, y) == own ? 1 : 0;
        },
        [&](int x, int y) {
          const auto colour = colour_at(x, y);
          ++ground;
          named += colour && *colour != kOtherColour ? 1 : 0;
        });
  }
};

void warn_of_overlaps(const std::vector<ColourBox>& boxes, std::vector<std::string>& warnings) {
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t j = i + 1; j < boxes.size() && boxes[j].colour != kOtherColour; ++j) {
      if (!overlap(boxes[i], boxes[j])) continue;
      const auto first = name_of_colour(boxes[i].colour), second = name_of_colour(boxes[j].colour);
      warnings.push_back(
          fmt::format("{} and {} overlap: what may be both is taken for {}", first, second, first));
    }
  }
}

void warn_of(const LearnedColour& learned, std::vector<std::string>& warnings) {
  const auto name = named(learned.colour).name;
  if (learned.pixels == 0) {
    warnings.push_back(fmt::format("nothing {} is in the image: it gets no thresholds", name));
  } else if (learned.told < kLeastTold) {
    warnings.push_back(
        fmt::format("only {:.0f} % of what should be {} is told to be: does everything stand where "
                    "the scenario says, and is it the right camera?",
                    100 * learned.told, name));
  } else if (learned.pixels < kFewPixels) {
    warnings.push_back(fmt::format("only {} pixels of {}: more frames make it surer", learned.pixels, name));
  }
}

}  // namespace

LearnedColours learn_colours(std::span<const KnownImage> images, std::span<const Colour> expected) {
  ColourLearner learner;
  for (const KnownImage& known : images) learner.add(known.image, known.floor.discs, known.floor.unknown);
  LearnedColours result;
  result.thresholds = {images.front().image.format, learner.boxes()};
  const ColourClasses classes(result.thresholds.boxes);
  Tally tally;
  for (const KnownImage& known : images) tally.add(known, classes);
  for (const Colour colour : expected) {
    const auto k = static_cast<std::size_t>(colour);
    const double told =
        tally.pixels[k] > 0 ? static_cast<double>(tally.told[k]) / static_cast<double>(tally.pixels[k]) : 0;
    result.colours.push_back({colour, tally.pixels[k], told});
    warn_of(result.colours.back(), result.warnings);
  }
  warn_of_overlaps(result.thresholds.boxes, result.warnings);
  if (tally.ground > 0)
    result.ground_named = static_cast<double>(tally.named) / static_cast<double>(tally.ground);
  if (result.ground_named > kMostGround)
    result.warnings.push_back(
        fmt::format("{:.1f} % of the ground looks like a named colour", 100 * result.ground_named));
  return result;
}

}  // namespace sidestep
