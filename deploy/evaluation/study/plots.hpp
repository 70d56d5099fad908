// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace sidestep {

/// The middle and the extremes of some trials at one place on the x axis.
struct PlotPoint {
  double x = 0;
  double middle = 0, low = 0, high = 0;
};

struct PlotLine {
  std::string title;
  std::vector<PlotPoint> points;
};

struct Plot {
  std::string title{}, x_label{}, y_label{};
  bool has_log_x = false, has_log_y = false;
  double least_y = 0;  ///< where a y axis that is not logarithmic begins
  std::vector<PlotLine> lines{};
  std::optional<double> marked_x{};  ///< by an upright line
};

/// Throws std::runtime_error, saying what to install, when there is no gnuplot.
void require_gnuplot();

/// Draws plots side by side into a PNG file by gnuplot. Throws std::runtime_error when that fails.
void draw(const std::vector<Plot>& plots, const std::string& png_file);

/// A value alone.
inline PlotPoint plot_point(double x, double value) { return {x, value, value, value}; }
/// The median, the least and the most of some values, of which there is at least one.
PlotPoint plot_point(double x, std::vector<double> values);

}  // namespace sidestep
