// SPDX-License-Identifier: Apache-2.0
#include "common/svg/palette.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>

namespace sidestep {
namespace {

/// The minimum contrast of text according to WCAG 2.1, level AA.
constexpr double kLegible = 4.5;
constexpr double kGoldenAngle_deg = 137.508;
constexpr std::array kFirst{"#0b62c4", "#b4500a", "#137a3a", "#b3122f", "#7a28c8", "#0b7285",
                            "#c2167f", "#5f6f0c", "#7a4a21", "#3f3fc4", "#3d4852", "#00695c"};

double linear(std::string_view colour, std::size_t channel) {
  int value = 0;
  const char* begin = colour.data() + 1 + 2 * channel;
  std::from_chars(begin, begin + 2, value, 16);
  const double share = value / 255.0;
  return share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
}

double luminance(std::string_view colour) {
  return 0.2126 * linear(colour, 0) + 0.7152 * linear(colour, 1) + 0.0722 * linear(colour, 2);
}

/// Converts hue, saturation and lightness.
std::string from_hsl(double hue_deg, double saturation, double lightness) {
  const double amplitude = saturation * std::min(lightness, 1 - lightness);
  const auto channel = [&](double shift) {
    const double k = std::fmod(shift + hue_deg / 30, 12);
    return static_cast<int>(
        std::lround(255 * (lightness - amplitude * std::max(-1.0, std::min({k - 3, 9 - k, 1.0})))));
  };
  return fmt::format("#{:02x}{:02x}{:02x}", channel(0), channel(8), channel(4));
}

}  // namespace

double contrast(std::string_view first, std::string_view second) {
  const double a = luminance(first), b = luminance(second);
  return (std::max(a, b) + 0.05) / (std::min(a, b) + 0.05);
}

std::string distinct_colour(std::size_t index) {
  if (index < kFirst.size()) return kFirst[index];
  const double hue_deg = std::fmod(kGoldenAngle_deg * static_cast<double>(index), 360);
  // Alternating lightness separates hues that look alike.
  double lightness = index % 2 == 0 ? 0.45 : 0.3;
  std::string colour = from_hsl(hue_deg, 0.75, lightness);
  while (contrast(colour, "#ffffff") < kLegible) {
    lightness -= 0.02;
    colour = from_hsl(hue_deg, 0.75, lightness);
  }
  return colour;
}

}  // namespace sidestep
