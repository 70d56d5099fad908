// SPDX-License-Identifier: Apache-2.0
#include "common/marking/layout.hpp"

#include <fmt/format.h>
#include <stdexcept>

#include "common/marking/symmetry.hpp"

namespace sidestep {
namespace {

using Part = LayoutFault::Part;

/// Dots that touch are as far apart as they have to be; rounding in files is forgiven.
constexpr double kRounding_m = 1e-6;

bool overlap(const MarkingDot& a, const MarkingDot& b) {
  return (a.position_m - b.position_m).norm() < a.radius_m + b.radius_m - kRounding_m;
}

std::optional<LayoutFault> dot_fault(const MarkingLayout& layout) {
  if (layout.dots.empty()) return LayoutFault{Part::kDots, 0, "expected at least one dot besides the centre"};
  if (layout.dots.size() > kMaxDots)
    return LayoutFault{Part::kDots, kMaxDots, fmt::format("expected at most {} dots", kMaxDots)};
  for (std::size_t i = 0; i < layout.dots.size(); ++i) {
    if (overlap(layout.dots[i], layout.centre))
      return LayoutFault{Part::kDots, i, "the dot overlaps the centre dot"};
    for (std::size_t j = 0; j < i; ++j)
      if (overlap(layout.dots[i], layout.dots[j]))
        return LayoutFault{Part::kDots, i, fmt::format("the dot overlaps dots[{}]", j)};
  }
  return std::nullopt;
}

std::optional<std::string> colour_fault(const MarkingLayout& layout, const MarkingPattern& pattern) {
  if (pattern.colours.size() != layout.dots.size())
    return fmt::format("expected {} colours, one for each dot, got {}", layout.dots.size(),
                       pattern.colours.size());
  for (const Colour colour : pattern.colours)
    if (colour == layout.blue_team || colour == layout.yellow_team)
      return fmt::format("{} is a team's colour, expected another", named(colour).name);
  return std::nullopt;
}

std::optional<LayoutFault> pattern_fault(const MarkingLayout& layout) {
  if (layout.patterns.empty()) return LayoutFault{Part::kPatterns, 0, "expected at least one pattern"};
  if (layout.patterns.size() > kMaxPatterns)
    return LayoutFault{Part::kPatterns, kMaxPatterns,
                       fmt::format("expected at most {} patterns", kMaxPatterns)};
  const std::vector<DotTurn> turns = turns_of(layout);
  for (std::size_t i = 0; i < layout.patterns.size(); ++i) {
    const MarkingPattern& pattern = layout.patterns[i];
    const auto fault = [&](std::string why) { return LayoutFault{Part::kPatterns, i, std::move(why)}; };
    if (const auto why = colour_fault(layout, pattern)) return fault(*why);
    for (std::size_t t = 1; t < turns.size(); ++t)
      if (differences(pattern.colours, pattern.colours, turns[t]) == 0)
        return fault(fmt::format("it does not tell the heading: turned by {:.0f} degrees it looks the same",
                                 turns[t].angle_rad * 180 / 3.14159265358979));
    for (std::size_t j = 0; j < i; ++j) {
      const MarkingPattern& other = layout.patterns[j];
      if (other.id == pattern.id) return fault(fmt::format("the id {} stands here twice", pattern.id));
      for (const DotTurn& turn : turns)
        if (differences(pattern.colours, other.colours, turn) == 0)
          return fault(fmt::format("it looks like that of id {}, turned by {:.0f} degrees", other.id,
                                   turn.angle_rad * 180 / 3.14159265358979));
    }
  }
  return std::nullopt;
}

}  // namespace

const MarkingPattern* MarkingLayout::find(std::uint32_t id) const {
  for (const MarkingPattern& pattern : patterns)
    if (pattern.id == id) return &pattern;
  return nullptr;
}

const MarkingPattern& pattern_of(const MarkingLayout& layout, RobotId robot) {
  if (const MarkingPattern* const pattern = layout.find(number_of(robot))) return *pattern;
  throw std::invalid_argument(fmt::format("robot {} has number {}, and the layout {} no such pattern", robot,
                                          number_of(robot), layout.name));
}

std::optional<LayoutFault> fault_of(const MarkingLayout& layout) {
  if (layout.blue_team == layout.yellow_team)
    return LayoutFault{Part::kCentre, 0, "both teams have one colour"};
  if (auto fault = dot_fault(layout)) return fault;
  return pattern_fault(layout);
}

}  // namespace sidestep
