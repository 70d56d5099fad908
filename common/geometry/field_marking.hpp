// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>

#include "common/geometry/field.hpp"
#include "common/geometry/segment.hpp"

namespace sidestep {

/// A straight line on the field, with the league's name for it.
struct MarkedLine {
  const char* name = "";
  Segment segment_m;
};

/// The lines and goals of the Small Size League's field (its rules, Field of Play), scaled to a given field.
/// Uses the dimensions of division A if the field is at least 10.5 m long, and of division B otherwise. The
/// width of lines and the depth and height of goals do not scale.
struct FieldMarking {
  double line_m = 0.01;  ///< width of all lines
  double goal_depth_m = 0.18;
  double goal_height_m = 0.155;
  double goal_width_m = 0;
  double area_depth_m = 0, area_width_m = 0;  ///< penalty areas, between line centres
  double centre_circle_radius_m = 0;          ///< at most a quarter of the field's width
  double penalty_mark_m = 0;                  ///< distance of the penalty mark from the goal
  /// The centres of all straight lines, in the order of the league's shape types (TopTouchLine, type 2,
  /// first).
  std::array<MarkedLine, 12> lines{};

  explicit FieldMarking(const Field& field) {
    const bool is_division_a = field.length_m >= 10.5;
    goal_width_m = field.width_m * (is_division_a ? 1.8 / 9 : 1.0 / 6);
    area_depth_m = field.length_m * (is_division_a ? 1.8 / 12 : 1.0 / 9);
    area_width_m = field.width_m * (is_division_a ? 3.6 / 9 : 2.0 / 6);
    centre_circle_radius_m = std::min(field.length_m * 0.5 / (is_division_a ? 12 : 9), field.width_m / 4);
    penalty_mark_m = field.length_m * 2 / 3;

    const double x = field.length_m / 2, y = field.width_m / 2;
    const double area_x = x - area_depth_m, area_y = area_width_m / 2;
    lines = {{{"TopTouchLine", {{-x, y}, {x, y}}},
              {"BottomTouchLine", {{-x, -y}, {x, -y}}},
              {"LeftGoalLine", {{-x, -y}, {-x, y}}},
              {"RightGoalLine", {{x, -y}, {x, y}}},
              {"HalfwayLine", {{0, -y}, {0, y}}},
              {"CenterLine", {{-x, 0}, {x, 0}}},
              {"LeftPenaltyStretch", {{-area_x, -area_y}, {-area_x, area_y}}},
              {"RightPenaltyStretch", {{area_x, -area_y}, {area_x, area_y}}},
              {"LeftFieldLeftPenaltyStretch", {{-x, -area_y}, {-area_x, -area_y}}},
              {"LeftFieldRightPenaltyStretch", {{-x, area_y}, {-area_x, area_y}}},
              {"RightFieldLeftPenaltyStretch", {{x, area_y}, {area_x, area_y}}},
              {"RightFieldRightPenaltyStretch", {{x, -area_y}, {area_x, -area_y}}}}};
  }
};

}  // namespace sidestep
