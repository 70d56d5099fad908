// SPDX-License-Identifier: Apache-2.0
#include "tests/study/table/plots.hpp"

#include <algorithm>
#include <array>
#include <cmath>
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

constexpr double kBarsShare = 0.8;          ///< of the distance between two categories
constexpr std::size_t kShortNames = 40;     ///< total characters of category names that fit side by side
constexpr double kLinesPerCharacter = 0.2;  ///< height of a slanted name

bool has_extremes(const PlotLine& line) {
  return std::ranges::any_of(line.points, [](const PlotPoint& p) { return p.min < p.max; });
}

/// How gnuplot draws a line: with error bars only where the extremes differ.
std::string line_elements(std::size_t number, const PlotLine& line) {
  return fmt::format("$line{} using {} pointtype 7 pointsize 0.7 title {}", number,
                     has_extremes(line) ? "1:2:3:4 with yerrorlines" : "1:2 with linespoints",
                     quoted(line.title));
}

/// How gnuplot draws a series of bars. The bars of one category stand side by side.
std::string bar_elements(std::size_t number, const Plot& plot) {
  const PlotLine& line = plot.lines[number];
  const double width = kBarsShare / static_cast<double>(plot.lines.size());
  const double shift = width * (static_cast<double>(number) + 0.5) - kBarsShare / 2;
  std::string elements = fmt::format("$line{} using ($1+({:.4f})):2 with boxes linetype {} title {}", number,
                                     shift, number + 1, quoted(line.title));
  if (has_extremes(line))
    elements += fmt::format(
        ", $line{} using ($1+({:.4f})):3:(0):($4-$3) with vectors nohead linecolor rgb '#222222' linewidth "
        "1.5 "
        "notitle",
        number, shift);
  return elements;
}

/// Whether the names of categories are slanted because they do not fit side by side.
bool has_slanted_names(const Plot& plot) {
  std::size_t characters = 0;
  for (const std::string& name : plot.categories) characters += name.size();
  return characters > kShortNames;
}

/// The lines of text below a plot: the axis, its label and the key.
std::size_t lines_below(const Plot& plot) {
  std::size_t longest = 0;
  for (const std::string& name : plot.categories) longest = std::max(longest, name.size());
  const double slanted = has_slanted_names(plot) ? kLinesPerCharacter * static_cast<double>(longest) : 0;
  return 4 + (plot.lines.size() + 1) / 2 + static_cast<std::size_t>(std::ceil(slanted));
}

std::string category_axis(const Plot& plot) {
  std::string names;
  for (std::size_t i = 0; i < plot.categories.size(); ++i)
    names += fmt::format("{}{} {}", i ? ", " : "", quoted(plot.categories[i]), i);
  return fmt::format(
      "set xtics {}({}) scale 0\nset xrange [-0.6:{}]\nset boxwidth {:.4f}\nset style fill solid 0.9\n",
      has_slanted_names(plot) ? "rotate by -25 " : "", names,
      static_cast<double>(plot.categories.size()) - 0.4,
      0.94 * kBarsShare / static_cast<double>(std::max<std::size_t>(1, plot.lines.size())));
}

}  // namespace

std::string gnuplot_script(const Plot& plot) {
  const bool has_categories = !plot.categories.empty();
  std::string text = fmt::format(
      "set title {}\nset xlabel {} offset 0,0.7\nset ylabel {}\nset yrange [{}:*]\nset xrange [*:*]\nset "
      "xtics "
      "norotate autofreq scale 1\nunset logscale\nunset arrow\nunset label\nset bmargin {}\n",
      quoted(plot.title), quoted(plot.x_label), quoted(plot.y_label),
      plot.has_log_y ? "*" : fmt::format("{}", plot.min_y), lines_below(plot));
  if (plot.has_log_x && !has_categories) text += "set logscale x\n";
  if (plot.has_log_y) text += "set logscale y\n";
  if (has_categories) text += category_axis(plot);
  if (plot.marked_x)
    text += fmt::format(
        "set arrow from {0},graph 0 to {0},graph 1 nohead dashtype 2\nset label '{0}' at {0},graph 0.95 "
        "offset 0.5\n",
        *plot.marked_x);
  std::string elements;
  for (std::size_t i = 0; i < plot.lines.size(); ++i) {
    const PlotLine& line = plot.lines[i];
    text += fmt::format("$line{} << EOD\n", i);
    for (const PlotPoint& p : line.points) text += fmt::format("{} {} {} {}\n", p.x, p.median, p.min, p.max);
    text += "EOD\n";
    elements += (i ? ", " : "") + (has_categories ? bar_elements(i, plot) : line_elements(i, line));
  }
  return text + "plot " + elements + "\n";
}

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
  for (const Plot& plot : plots) text += gnuplot_script(plot);
  const bool is_written = std::fwrite(text.data(), 1, text.size(), gnuplot) == text.size();
  if (pclose(gnuplot) != 0 || !is_written) throw std::runtime_error("gnuplot failed to draw " + png_file);
}

PlotPoint plot_point(double x, std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return {x, values[values.size() / 2], values.front(), values.back()};
}

}  // namespace sidestep
