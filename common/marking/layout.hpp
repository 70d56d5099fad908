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

/// A coloured dot on top of a robot; Bruce, CMU-CS-06-181, appendix A.2.1, calls it a patch.
struct Marker {
  Vec2 position_m{0, 0};  ///< in the robot's frame: x ahead, y to the left
  double radius_m = 0.02;
};

/// The marker colours of one robot of a team.
struct MarkerPattern {
  std::uint32_t id = 0;
  std::vector<Colour> colours;  ///< colours of the layout's dots, in order
};

/// The arrangement of markers on top of a robot. The centre marker's colour identifies the team, the other
/// dots' colours identify the robot, and their positions give the heading.
struct MarkerLayout {
  std::string name;
  Marker centre;
  Colour blue_team = Colour::kBlue;
  Colour yellow_team = Colour::kYellow;
  std::vector<Marker> dots;             ///< all dots except the centre marker
  std::vector<MarkerPattern> patterns;  ///< patterns with distinct ids

  Colour team_colour(Team team) const { return team == Team::kBlue ? blue_team : yellow_team; }
  /// The pattern with an id, or nullptr.
  const MarkerPattern* find(std::uint32_t id) const;
};

/// The pattern of the robot with this number. Throws std::invalid_argument if the layout has none.
const MarkerPattern& pattern_of(const MarkerLayout& layout, RobotId robot);

/// The invalid part of a layout, and the reason.
struct LayoutError {
  enum class Part { kCentre, kDots, kPatterns } part = Part::kCentre;
  std::size_t index = 0;  ///< index of the invalid dot or pattern
  std::string why;
};

inline constexpr std::size_t kMaxDots = 12;
inline constexpr std::size_t kMaxPatterns = 1024;

/// Returns the first error in a layout: overlapping dots, ambiguous colours, patterns that look the same
/// after a rotation, or patterns with an ambiguous heading.
[[nodiscard]] std::optional<LayoutError> validation_error(const MarkerLayout& layout);

}  // namespace sidestep
