// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "common/geometry/field.hpp"

namespace sidestep {

/// The lines and goals of the Small Size League's field (its rules, Field of Play) in proportion to a field:
/// those of division A where it is at least 10.5 m long, of division B otherwise. Lines are as wide, and
/// goals as deep and high, on any field.
struct FieldMarking {
  double line_m = 0.01;  ///< width of all lines
  double goal_depth_m = 0.18;
  double goal_height_m = 0.155;
  double goal_width_m = 0;
  double area_depth_m = 0, area_width_m = 0;  ///< of the penalty areas, between the lines' middles
  double centre_circle_radius_m = 0;          ///< at most a quarter of the width
  double penalty_mark_m = 0;                  ///< from the goal

  explicit FieldMarking(const Field& field) {
    const bool is_division_a = field.length_m >= 10.5;
    goal_width_m = field.width_m * (is_division_a ? 1.8 / 9 : 1.0 / 6);
    area_depth_m = field.length_m * (is_division_a ? 1.8 / 12 : 1.0 / 9);
    area_width_m = field.width_m * (is_division_a ? 3.6 / 9 : 2.0 / 6);
    centre_circle_radius_m = std::min(field.length_m * 0.5 / (is_division_a ? 12 : 9), field.width_m / 4);
    penalty_mark_m = field.length_m * 2 / 3;
  }
};

}  // namespace sidestep
