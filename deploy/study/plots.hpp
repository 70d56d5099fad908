// SPDX-License-Identifier: Apache-2.0
#pragma once

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
  bool has_log_x = false;
  std::vector<PlotLine> lines{};
};

/// Throws std::runtime_error, saying what to install, when there is no gnuplot.
void require_gnuplot();

/// Draws a plot into a PNG file by gnuplot. Throws std::runtime_error when that fails.
void draw(const Plot& plot, const std::string& png_file);

}  // namespace sidestep
