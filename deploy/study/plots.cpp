// SPDX-License-Identifier: Apache-2.0
#include "deploy/study/plots.hpp"

#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <stdexcept>

namespace sidestep {
namespace {

/// In gnuplot's single quotes, within which only these stand for themselves when doubled.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? "''" : std::string(1, c);
  return result + "'";
}

std::string script(const Plot& plot, const std::string& png_file) {
  std::string text = fmt::format(
      "set terminal pngcairo size 720,440 font 'sans,10' noenhanced\nset output {}\nset title {}\n"
      "set xlabel {}\nset ylabel {}\nset grid\nset key outside bottom center horizontal\nset yrange [0:*]\n",
      quoted(png_file), quoted(plot.title), quoted(plot.x_label), quoted(plot.y_label));
  if (plot.has_log_x) text += "set logscale x\n";
  std::string lines;
  for (std::size_t i = 0; i < plot.lines.size(); ++i) {
    text += fmt::format("$line{} << EOD\n", i);
    for (const PlotPoint& p : plot.lines[i].points)
      text += fmt::format("{} {} {} {}\n", p.x, p.middle, p.low, p.high);
    text += "EOD\n";
    lines += fmt::format("{}$line{} using 1:2:3:4 with yerrorlines pointtype 7 pointsize 0.7 title {}",
                         i ? ", " : "", i, quoted(plot.lines[i].title));
  }
  return text + "plot " + lines + "\n";
}

}  // namespace

void require_gnuplot() {
  if (std::system("gnuplot --version >/dev/null 2>&1") != 0)
    throw std::runtime_error("gnuplot, which draws the plots, is missing; install gnuplot-nox");
}

void draw(const Plot& plot, const std::string& png_file) {
  std::FILE* gnuplot = popen("gnuplot", "w");
  if (!gnuplot) throw std::runtime_error("gnuplot cannot be started");
  const std::string text = script(plot, png_file);
  const bool is_written = std::fwrite(text.data(), 1, text.size(), gnuplot) == text.size();
  if (pclose(gnuplot) != 0 || !is_written) throw std::runtime_error("gnuplot could not draw " + png_file);
}

}  // namespace sidestep
