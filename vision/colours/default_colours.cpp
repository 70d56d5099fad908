// SPDX-License-Identifier: Apache-2.0
#include "vision/colours/default_colours.hpp"

#include <array>
#include <set>

#include "common/image/pixel_writing.hpp"
#include "vision/colours/colour_learner.hpp"

namespace sidestep {
namespace {

/// Shares of the full light.
struct Lights {
  double low, high;
};
constexpr Lights kAll{0.55, 1}, kBright{0.75, 1}, kDim{0.55, 0.75};
constexpr double kStep = 0.05;
constexpr double kLeastLight = 0.7;  // of that: nearer to black, patches grow too large
constexpr double kNoise = 4;         // of 255, in red, green and blue
constexpr int kCarpet = 20;          // times as much of it as of white and of black

/// What a camera makes of two pixels of one colour.
Yuv seen_as(PixelFormat format, const Rgb& colour) {
  Image pair(PixelFormat::kRgb, 2, 1);
  for (int x = 0; x < 2; ++x) {
    std::uint8_t* const pixel = pair.pixels() + 3 * x;
    pixel[0] = colour.r;
    pixel[1] = colour.g;
    pixel[2] = colour.b;
  }
  return pixel_at(written_as(format, pair.view()).view(), 0, 0);
}

/// Calls `see` with a colour in lights, with noise to and fro in each of red, green and blue.
template <typename See>
void in_lights(const Lights& lights, PixelFormat format, Colour colour, See see) {
  const Rgb& full = named(colour).rgb;
  constexpr std::array kNoises{-kNoise, 0.0, kNoise};
  for (double light = lights.high; light > lights.low - kStep / 2; light -= kStep) {
    for (const double red : kNoises)
      for (const double green : kNoises)
        for (const double blue : kNoises)
          see(seen_as(format, {to_byte(light * full.r + red), to_byte(light * full.g + green),
                               to_byte(light * full.b + blue)}));
  }
}

std::set<Colour> colours_to_know(const MarkingLayout& layout) {
  std::set<Colour> colours{Colour::kOrange, layout.blue_team, layout.yellow_team};
  for (const MarkingPattern& pattern : layout.patterns)
    colours.insert(pattern.colours.begin(), pattern.colours.end());
  return colours;
}

}  // namespace

ColourThresholds default_colours(PixelFormat format, const MarkingLayout& layout) {
  const std::set<Colour> known = colours_to_know(layout);
  ColourLearner ground(kLeastLight);
  for (const Colour colour : {Colour::kField, Colour::kWhite, Colour::kBlack}) {
    if (known.contains(colour)) continue;
    const int times = colour == Colour::kField ? kCarpet : 1;
    in_lights(kAll, format, colour, [&](const Yuv& pixel) {
      for (int i = 0; i < times; ++i) ground.add_background(pixel);
    });
  }
  ColourThresholds thresholds{format, {}};
  // Orange in dim light has yellow's U and V in bright light; each has boxes for both, one above the other.
  for (const Lights& lights : {kBright, kDim}) {
    ColourLearner learner = ground;
    for (const Colour colour : known)
      in_lights(lights, format, colour, [&](const Yuv& pixel) { learner.add(colour, pixel); });
    for (ColourBox box : learner.named_boxes()) {
      Rgb between = kColours[box.colour].rgb;
      for (std::uint8_t* const part : {&between.r, &between.g, &between.b})
        *part = to_byte(kDim.high * *part);
      const std::uint8_t y = seen_as(format, between).y;
      (lights.low == kBright.low ? box.low.y : box.high.y) = y;
      thresholds.boxes.push_back(box);
    }
  }
  const std::vector<ColourBox> others = ground.other_boxes();
  thresholds.boxes.insert(thresholds.boxes.end(), others.begin(), others.end());
  return thresholds;
}

}  // namespace sidestep
