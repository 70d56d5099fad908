// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace sidestep {

/// The median and the extremes of some trials at one position of the x axis.
struct PlotPoint {
  double x = 0;
  double median = 0, min = 0, max = 0;
};

struct PlotLine {
  std::string title;
  std::vector<PlotPoint> points;
};

struct Plot {
  std::string title{}, x_label{}, y_label{};
  bool has_log_x = false, has_log_y = false;
  double min_y = 0;  ///< lower end of a y axis that is not logarithmic
  std::vector<PlotLine> lines{};
  std::optional<double> marked_x{};  ///< position of a vertical line; nullopt: no line
  /// Names of the positions 0, 1, ... of the x axis if these are categories, for example kinds of scenes.
  /// Each line then becomes a series of bars, because there is nothing between two categories.
  std::vector<std::string> categories{};
};

/// Throws std::runtime_error, which names the package to install, if gnuplot is not installed.
void require_gnuplot();

/// The commands by which gnuplot draws the plot.
[[nodiscard]] std::string gnuplot_script(const Plot& plot);

/// Draws plots side by side into a PNG file with gnuplot. Throws std::runtime_error if that fails.
void draw(const std::vector<Plot>& plots, const std::string& png_file);

/// A point with a single value.
inline PlotPoint plot_point(double x, double value) { return {x, value, value, value}; }
/// A point with the median, minimum and maximum of the values, of which there must be at least one.
PlotPoint plot_point(double x, std::vector<double> values);

}  // namespace sidestep
