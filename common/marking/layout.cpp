// SPDX-License-Identifier: Apache-2.0
#include "common/marking/layout.hpp"

#include <fmt/format.h>
#include <numbers>
#include <stdexcept>

#include "common/marking/symmetry.hpp"

namespace sidestep {
namespace {

using Part = LayoutError::Part;

/// Dots may touch; allows for rounding in files.
constexpr double kRounding_m = 1e-6;

bool overlap(const Marker& a, const Marker& b) {
  return (a.position_m - b.position_m).norm() < a.radius_m + b.radius_m - kRounding_m;
}

std::optional<LayoutError> dot_error(const MarkerLayout& layout) {
  if (layout.dots.empty()) return LayoutError{Part::kDots, 0, "expected at least one dot besides the centre"};
  if (layout.dots.size() > kMaxDots)
    return LayoutError{Part::kDots, kMaxDots, fmt::format("expected at most {} dots", kMaxDots)};
  for (std::size_t i = 0; i < layout.dots.size(); ++i) {
    if (overlap(layout.dots[i], layout.centre))
      return LayoutError{Part::kDots, i, "the dot overlaps the centre dot"};
    for (std::size_t j = 0; j < i; ++j)
      if (overlap(layout.dots[i], layout.dots[j]))
        return LayoutError{Part::kDots, i, fmt::format("the dot overlaps dots[{}]", j)};
  }
  return std::nullopt;
}

std::optional<std::string> colour_error(const MarkerLayout& layout, const MarkerPattern& pattern) {
  if (pattern.colours.size() != layout.dots.size())
    return fmt::format("expected {} colours, one per dot, got {}", layout.dots.size(),
                       pattern.colours.size());
  for (const Colour colour : pattern.colours)
    if (colour == layout.blue_team || colour == layout.yellow_team)
      return fmt::format("{} is a team colour, expected a different colour", named(colour).name);
  return std::nullopt;
}

std::optional<LayoutError> pattern_error(const MarkerLayout& layout) {
  if (layout.patterns.empty()) return LayoutError{Part::kPatterns, 0, "expected at least one pattern"};
  if (layout.patterns.size() > kMaxPatterns)
    return LayoutError{Part::kPatterns, kMaxPatterns,
                       fmt::format("expected at most {} patterns", kMaxPatterns)};
  const std::vector<RotationalSymmetry> symmetries = rotational_symmetries(layout);
  for (std::size_t i = 0; i < layout.patterns.size(); ++i) {
    const MarkerPattern& pattern = layout.patterns[i];
    const auto error_at = [&](std::string why) { return LayoutError{Part::kPatterns, i, std::move(why)}; };
    if (const auto why = colour_error(layout, pattern)) return error_at(*why);
    for (std::size_t t = 1; t < symmetries.size(); ++t)
      if (hamming_distance(pattern.colours, pattern.colours, symmetries[t]) == 0)
        return error_at(
            fmt::format("the heading is ambiguous: the pattern looks the same rotated by {:.0f} degrees",
                        symmetries[t].angle_rad * 180 / std::numbers::pi));
    for (std::size_t j = 0; j < i; ++j) {
      const MarkerPattern& other = layout.patterns[j];
      if (other.id == pattern.id) return error_at(fmt::format("duplicate id {}", pattern.id));
      for (const RotationalSymmetry& symmetry : symmetries)
        if (hamming_distance(pattern.colours, other.colours, symmetry) == 0)
          return error_at(fmt::format("it looks like the pattern of id {} rotated by {:.0f} degrees",
                                      other.id, symmetry.angle_rad * 180 / std::numbers::pi));
    }
  }
  return std::nullopt;
}

}  // namespace

const MarkerPattern* MarkerLayout::find(std::uint32_t id) const {
  for (const MarkerPattern& pattern : patterns)
    if (pattern.id == id) return &pattern;
  return nullptr;
}

const MarkerPattern& pattern_of(const MarkerLayout& layout, RobotId robot) {
  if (const MarkerPattern* const pattern = layout.find(number_in_team(robot))) return *pattern;
  throw std::invalid_argument(
      fmt::format("robot {} has number {}, for which the marker layout {} has no pattern", robot,
                  number_in_team(robot), layout.name));
}

std::optional<LayoutError> validation_error(const MarkerLayout& layout) {
  if (layout.blue_team == layout.yellow_team)
    return LayoutError{Part::kCentre, 0, "both teams have the same colour"};
  if (auto error = dot_error(layout)) return error;
  return pattern_error(layout);
}

}  // namespace sidestep
