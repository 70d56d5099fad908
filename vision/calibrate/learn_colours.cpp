// SPDX-License-Identifier: Apache-2.0
#include "vision/calibrate/learn_colours.hpp"

#include <array>
#include <fmt/format.h>

#include "vision/colours/labelled_pixels.hpp"
#include "vision/segmentation/colour_classes.hpp"

namespace sidestep {
namespace {

constexpr std::uint64_t kMinPixels = 30;
constexpr double kMinRecall = 0.95;
constexpr double kMaxGroundFalsePositives = 0.002;  // of a frame: about the area of a dot

bool overlap(const ColourBox& a, const ColourBox& b) {
  const auto intersect = [](std::uint8_t al, std::uint8_t ah, std::uint8_t bl, std::uint8_t bh) {
    return al <= bh && bl <= ah;
  };
  return intersect(a.low.y, a.high.y, b.low.y, b.high.y) && intersect(a.low.u, a.high.u, b.low.u, b.high.u) &&
         intersect(a.low.v, a.high.v, b.low.v, b.high.v);
}

/// Counts how the thresholds classify the labelled pixels.
struct Tally {
  std::array<std::uint64_t, kColours.size()> labelled{}, correct{};
  std::uint64_t background = 0, false_positives = 0;

  void add(const LabelledImage& labelled_image, const ColourClasses& classes) {
    const auto colour_at = [&](int x, int y) {
      return classes.colour_of(pixel_at(labelled_image.image, x, y));
    };
    for_labelled_pixels(
        labelled_image.image, labelled_image.labels.discs, labelled_image.labels.ignored,
        [&](const LabelledDisc& disc, int x, int y) {
          const auto label = static_cast<std::size_t>(disc.colour);
          ++labelled[label];
          correct[label] += colour_at(x, y) == label ? 1 : 0;
        },
        [&](int x, int y) {
          const auto colour = colour_at(x, y);
          ++background;
          false_positives += colour && *colour != kOtherColour ? 1 : 0;
        });
  }
};

void warn_of_overlaps(const std::vector<ColourBox>& boxes, std::vector<std::string>& warnings) {
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t j = i + 1; j < boxes.size() && boxes[j].colour != kOtherColour; ++j) {
      if (!overlap(boxes[i], boxes[j])) continue;
      const auto first = name_of_colour(boxes[i].colour), second = name_of_colour(boxes[j].colour);
      warnings.push_back(
          fmt::format("{} and {} overlap: pixels in both boxes are classified as {}", first, second, first));
    }
  }
}

void warn_of(const LearnedColour& learned, std::vector<std::string>& warnings) {
  const auto name = named(learned.colour).name;
  if (learned.pixels == 0) {
    warnings.push_back(fmt::format("the images show nothing {}: the file gets no thresholds for it", name));
  } else if (learned.recall < kMinRecall) {
    warnings.push_back(
        fmt::format("only {:.0f} % of the pixels labelled {} are classified as {}: check that "
                    "everything is at its start position and that the camera is the right one",
                    100 * learned.recall, name, name));
  } else if (learned.pixels < kMinPixels) {
    warnings.push_back(
        fmt::format("only {} pixels of {}: more frames give more reliable thresholds", learned.pixels, name));
  }
}

}  // namespace

LearnedColours learn_colours(std::span<const LabelledImage> images, std::span<const Colour> expected) {
  ColourLearner learner;
  for (const LabelledImage& one : images) learner.add(one.image, one.labels.discs, one.labels.ignored);
  LearnedColours result;
  result.thresholds = {images.front().image.format, learner.boxes()};
  const ColourClasses classes(result.thresholds.boxes);
  Tally tally;
  for (const LabelledImage& one : images) tally.add(one, classes);
  for (const Colour colour : expected) {
    const auto k = static_cast<std::size_t>(colour);
    const double recall = tally.labelled[k] > 0
                              ? static_cast<double>(tally.correct[k]) / static_cast<double>(tally.labelled[k])
                              : 0;
    result.colours.push_back({colour, tally.labelled[k], recall});
    warn_of(result.colours.back(), result.warnings);
  }
  warn_of_overlaps(result.thresholds.boxes, result.warnings);
  if (tally.background > 0)
    result.ground_false_positives =
        static_cast<double>(tally.false_positives) / static_cast<double>(tally.background);
  if (result.ground_false_positives > kMaxGroundFalsePositives)
    result.warnings.push_back(fmt::format("{:.1f} % of the background is classified as a named colour",
                                          100 * result.ground_false_positives));
  return result;
}

}  // namespace sidestep
