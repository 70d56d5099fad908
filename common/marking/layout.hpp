// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/geometry/vec2.hpp"
#include "common/marking/colours.hpp"

namespace sidestep {

struct MarkingDot {
  Vec2 position_m{0, 0};  ///< in the robot's frame: x ahead, y to the left
  double radius_m = 0.02;
};

/// What one robot of a team wears.
struct MarkingPattern {
  std::uint32_t id = 0;
  std::vector<Colour> colours;  ///< of the layout's dots, in their order
};

/// The dots on a robot's top. The centre dot's colour says the team, those of the others the id; where they
/// stand says the heading.
struct MarkingLayout {
  std::string name;
  MarkingDot centre;
  Colour blue_team = Colour::kBlue;
  Colour yellow_team = Colour::kYellow;
  std::vector<MarkingDot> dots;          ///< all but the centre
  std::vector<MarkingPattern> patterns;  ///< their ids differ

  Colour team_colour(Team team) const { return team == Team::kBlue ? blue_team : yellow_team; }
  /// The pattern with an id, or nullptr.
  const MarkingPattern* find(std::uint32_t id) const;
};

/// What a robot wears: the pattern of its number. Throws std::invalid_argument when the layout has none.
const MarkingPattern& pattern_of(const MarkingLayout& layout, RobotId robot);

/// The part of a layout that is wrong, and why.
struct LayoutFault {
  enum class Part { kCentre, kDots, kPatterns } part = Part::kCentre;
  std::size_t index = 0;  ///< of the dot or pattern
  std::string why;
};

inline constexpr std::size_t kMaxDots = 12;
inline constexpr std::size_t kMaxPatterns = 1024;

/// The first thing that is wrong: dots that overlap, colours that mean two things, patterns that look the
/// same when the robot turns, or that do not tell the heading.
std::optional<LayoutFault> fault_of(const MarkingLayout& layout);

}  // namespace sidestep
