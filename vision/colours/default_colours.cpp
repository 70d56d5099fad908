// SPDX-License-Identifier: Apache-2.0
#include "vision/colours/default_colours.hpp"

#include <array>
#include <set>

#include "common/image/pixel_conversion.hpp"
#include "vision/colours/colour_learner.hpp"

namespace sidestep {
namespace {

/// A range of brightness, as fractions of full light.
struct LightRange {
  double low, high;
};
constexpr LightRange kAll{0.55, 1}, kBright{0.75, 1}, kDim{0.55, 0.75};
constexpr double kStep = 0.05;
// Relative to the dimmest light. With thresholds closer to black, regions would grow too large.
constexpr double kMinLightRatio = 0.7;
constexpr double kNoise = 4;      // in levels of 255, in red, green and blue
constexpr int kFieldWeight = 20;  // frequency of the field surface, relative to white and black

/// The value of a colour in a frame, taken from two neighbouring pixels that show it.
Yuv yuv_in_frame(PixelFormat format, const Rgb& colour) {
  Image pair(PixelFormat::kRgb, 2, 1);
  for (int x = 0; x < 2; ++x) {
    std::uint8_t* const pixel = pair.pixels() + 3 * x;
    pixel[0] = colour.r;
    pixel[1] = colour.g;
    pixel[2] = colour.b;
  }
  return pixel_at(converted_to(format, pair.view()).view(), 0, 0);
}

/// Calls `visit` with samples of a colour over a range of light, with positive and negative noise in each of
/// red, green and blue.
template <typename Visit>
void sample_lights(const LightRange& lights, PixelFormat format, Colour colour, Visit visit) {
  const Rgb& full = named(colour).rgb;
  constexpr std::array kNoises{-kNoise, 0.0, kNoise};
  for (double light = lights.high; light > lights.low - kStep / 2; light -= kStep) {
    for (const double red : kNoises)
      for (const double green : kNoises)
        for (const double blue : kNoises)
          visit(yuv_in_frame(format, {to_byte(light * full.r + red), to_byte(light * full.g + green),
                                      to_byte(light * full.b + blue)}));
  }
}

std::set<Colour> named_colours_of(const MarkerLayout& layout) {
  std::set<Colour> colours{Colour::kOrange, layout.blue_team, layout.yellow_team};
  for (const MarkerPattern& pattern : layout.patterns)
    colours.insert(pattern.colours.begin(), pattern.colours.end());
  return colours;
}

}  // namespace

ColourThresholds default_colours(PixelFormat format, const MarkerLayout& layout) {
  const std::set<Colour> known = named_colours_of(layout);
  ColourLearner ground(kMinLightRatio);
  for (const Colour colour : {Colour::kField, Colour::kWhite, Colour::kBlack}) {
    if (known.contains(colour)) continue;
    const int weight = colour == Colour::kField ? kFieldWeight : 1;
    sample_lights(kAll, format, colour, [&](const Yuv& pixel) {
      for (int i = 0; i < weight; ++i) ground.add_background(pixel);
    });
  }
  ColourThresholds thresholds{format, {}};
  // Orange in dim light has the U and V of yellow in bright light: each colour gets one box for bright and
  // one for dim light, which adjoin in brightness.
  for (const LightRange& lights : {kBright, kDim}) {
    ColourLearner learner = ground;
    for (const Colour colour : known)
      sample_lights(lights, format, colour, [&](const Yuv& pixel) { learner.add(colour, pixel); });
    for (ColourBox box : learner.named_boxes()) {
      Rgb border = kColours[box.colour].rgb;
      for (std::uint8_t* const component : {&border.r, &border.g, &border.b})
        *component = to_byte(kDim.high * *component);
      const std::uint8_t y = yuv_in_frame(format, border).y;
      (lights.low == kBright.low ? box.low.y : box.high.y) = y;
      thresholds.boxes.push_back(box);
    }
  }
  const std::vector<ColourBox> others = ground.other_boxes();
  thresholds.boxes.insert(thresholds.boxes.end(), others.begin(), others.end());
  return thresholds;
}

}  // namespace sidestep
