// SPDX-License-Identifier: Apache-2.0
#include "tests/study/table/plots.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <stdexcept>

namespace sidestep {
namespace {

constexpr std::array kLineColours{"#9400d3", "#009e73", "#2a78c8", "#e69f00", "#8c5a3c",
                                  "#222222", "#d62728", "#ff7fbf", "#8f8f8f", "#17becf",
                                  "#b0b000", "#f0a0a0", "#70d070", "#a0a0ff", "#005050"};

/// Quotes text for gnuplot: within single quotes, only a single quote has to be doubled.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? "''" : std::string(1, c);
  return result + "'";
}

/// Draws error bars only where the extremes differ.
std::string script(const Plot& plot) {
  std::string text = fmt::format(
      "set title {}\nset xlabel {} offset 0,0.7\nset ylabel {}\nset yrange [{}:*]\nunset logscale\n"
      "unset arrow\nunset label\nset bmargin {}\n",
      quoted(plot.title), quoted(plot.x_label), quoted(plot.y_label),
      plot.has_log_y ? "*" : fmt::format("{}", plot.min_y), 4 + (plot.lines.size() + 1) / 2);
  if (plot.has_log_x) text += "set logscale x\n";
  if (plot.has_log_y) text += "set logscale y\n";
  if (plot.marked_x)
    text += fmt::format(
        "set arrow from {0},graph 0 to {0},graph 1 nohead dashtype 2\nset label '{0}' at {0},graph 0.95 "
        "offset 0.5\n",
        *plot.marked_x);
  std::string lines;
  for (std::size_t i = 0; i < plot.lines.size(); ++i) {
    const PlotLine& line = plot.lines[i];
    text += fmt::format("$line{} << EOD\n", i);
    for (const PlotPoint& p : line.points) text += fmt::format("{} {} {} {}\n", p.x, p.median, p.min, p.max);
    text += "EOD\n";
    const bool has_bars =
        std::any_of(line.points.begin(), line.points.end(), [](const PlotPoint& p) { return p.min < p.max; });
    lines += fmt::format("{}$line{} using {} pointtype 7 pointsize 0.7 title {}", i ? ", " : "", i,
                         has_bars ? "1:2:3:4 with yerrorlines" : "1:2 with linespoints", quoted(line.title));
  }
  return text + "plot " + lines + "\n";
}

}  // namespace

void require_gnuplot() {
  if (std::system("gnuplot --version >/dev/null 2>&1") != 0)
    throw std::runtime_error("gnuplot, which draws the plots, is not installed; install gnuplot-nox");
}

void draw(const std::vector<Plot>& plots, const std::string& png_file) {
  std::FILE* gnuplot = popen("gnuplot", "w");
  if (!gnuplot) throw std::runtime_error("cannot start gnuplot");
  const std::size_t width = plots.size() == 1 ? 720 : plots.size() == 2 ? 1040 : 400 * plots.size();
  std::string text = fmt::format(
      "set terminal pngcairo size {},440 font 'sans,10' noenhanced\nset output {}\nset grid\n"
      "set key below horizontal samplen 2\nset autoscale xfix\nset multiplot layout 1,{}\n",
      width, quoted(png_file), plots.size());
  for (std::size_t i = 0; i < kLineColours.size(); ++i)
    text += fmt::format("set linetype {} linecolor rgb '{}'\n", i + 1, kLineColours[i]);
  for (const Plot& plot : plots) text += script(plot);
  const bool is_written = std::fwrite(text.data(), 1, text.size(), gnuplot) == text.size();
  if (pclose(gnuplot) != 0 || !is_written) throw std::runtime_error("gnuplot failed to draw " + png_file);
}

PlotPoint plot_point(double x, std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return {x, values[values.size() / 2], values.front(), values.back()};
}

}  // namespace sidestep
