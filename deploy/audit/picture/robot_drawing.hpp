// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/svg/floor_view.hpp"
#include "deploy/audit/metrics/floor_trace.hpp"
#include "deploy/audit/picture/run_timing.hpp"

namespace sidestep {

/// How large and how detailed the robots of a picture are drawn.
struct RobotStyle {
  double disc_px = 9;                 ///< radius of a robot's disc: its true size, unless that is illegible
  double enlargement = 1;             ///< of the disc, relative to the true size
  bool has_numbers = true;            ///< on the discs; many robots have none
  bool has_trails = true;             ///< the driven part of a path is drawn stronger as the picture plays
  bool has_teams = false;             ///< there are robots of both teams
  double line_px = 2.5, mark_px = 2;  ///< widths of the lines of paths, and of starts and goals
  double arrow_period_s = 1;          ///< time between two arrows of a path
};

[[nodiscard]] RobotStyle robot_style(const FloorTrace& trace, const FloorView& view, const RunTiming& timing);

/// Parts of the drawing of one robot, in the order in which they cover each other.
struct RobotDrawing {
  std::string path, goals, start, disc;
};

[[nodiscard]] RobotDrawing draw_robot(const FloorTrace::Robot& robot, const std::string& colour,
                                      const RobotStyle& style, const FloorView& view,
                                      const RunTiming& timing);

/// A square on its corner, as the data of a path: the mark of a goal.
[[nodiscard]] std::string goal_mark_data(const Vec2& centre_px, double radius_px);

[[nodiscard]] const char* colour_of(Team team);

}  // namespace sidestep
