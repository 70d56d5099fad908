// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/geometry/vec2.hpp"

namespace sidestep {

// Charts for pages. They take the colour of text from the page (class "chart").

struct ChartBar {
  std::string label;
  double value = 0;
  std::string value_text;  ///< at the end of the bar
  std::string colour;
};

struct BarAxis {
  std::string label;
  bool is_logarithmic = false;  ///< values of 0 or less then have no bar
};

/// Horizontal bars, one below the other, to compare categories.
[[nodiscard]] std::string bar_chart(const std::vector<ChartBar>& bars, const BarAxis& axis);

struct ChartLine {
  std::string label;  ///< shown when the pointer rests on the line
  std::string colour;
  std::vector<Vec2> points;  ///< ascending in x
};

struct LineAxes {
  std::string x_label, y_label;
  std::optional<double> marked_y{};  ///< a dashed horizontal line
  std::string mark_label{};
};

/// Lines over a continuous quantity such as time. The y axis begins at 0.
[[nodiscard]] std::string line_chart(const std::vector<ChartLine>& lines, const LineAxes& axes);

}  // namespace sidestep
