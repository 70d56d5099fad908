// SPDX-License-Identifier: Apache-2.0
#include "common/svg/charts.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "common/file/xml_text.hpp"
#include "common/svg/axis.hpp"
#include "common/svg/svg.hpp"

namespace sidestep {
namespace {

constexpr double kWidth_px = 900, kChartFont_px = 13;
constexpr double kMinBarRoom_px = 100;
constexpr double kMinValue = 1e-280, kMaxValue = 1e280;  // of the end of an axis
constexpr double kMaxRatio = 1e12;                       // of the ends of a logarithmic axis
constexpr double kRow_px = 26, kBar_px = 16, kMaxLabel_px = 260, kAxisBottom_px = 42;
constexpr double kPlotHeight_px = 280, kPlotLeft_px = 56, kPlotTop_px = 14, kPlotRight_px = 16;
constexpr const char* kTick = "font-size='12' fill-opacity='0.75'";
constexpr const char* kGrid = "fill='none' stroke='currentColor' stroke-opacity='0.18'";

std::string chart(double height_px, const std::string& content) {
  return fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' class='chart' viewBox='0 0 {:.0f} {:.0f}' "
      "font-family='sans-serif' font-size='{:.0f}' fill='currentColor'>\n{}</svg>\n",
      kWidth_px, height_px, kChartFont_px, content);
}

/// Maps values to shares of an axis.
struct Scale {
  double from = 0, to = 1;
  bool is_logarithmic = false;
  std::vector<double> marks{};
  double step = 1;  ///< between marks, if not logarithmic

  double share(double value) const {
    if (is_logarithmic)
      return value > 0 ? (std::log10(value) - std::log10(from)) / (std::log10(to) - std::log10(from)) : 0;
    return (value - from) / (to - from);
  }
  std::string label(double value) const {
    return is_logarithmic ? fmt::format("{:g}", value) : tick_label(value, step);
  }
};

/// From 0 to at least `max`, with marks that are at least this share of the axis apart.
Scale linear_scale(double max, double spacing_share) {
  Scale scale;
  scale.to = max > 0 ? std::clamp(max, kMinValue, kMaxValue) : 1;
  scale.step = round_step(scale.to * spacing_share);
  scale.to = scale.step * std::ceil(scale.to / scale.step - 1e-9);
  scale.marks = ticks(0, scale.to, scale.step);
  return scale;
}

Scale logarithmic_scale(double min, double max) {
  Scale scale;
  scale.is_logarithmic = true;
  max = std::clamp(max, kMinValue, kMaxValue);
  min = std::clamp(min, max / kMaxRatio, max);
  scale.from = std::pow(10, std::floor(std::log10(min)));
  scale.to = std::max(10 * scale.from, std::pow(10, std::ceil(std::log10(max) - 1e-9)));
  for (double mark = scale.from; mark < 1.001 * scale.to; mark *= 10) scale.marks.push_back(mark);
  return scale;
}

Scale scale_of(const std::vector<ChartBar>& bars, const BarAxis& axis, double length_px) {
  double min = std::numeric_limits<double>::infinity(), max = 0;
  for (const ChartBar& bar : bars) {
    if (bar.value > 0) min = std::min(min, bar.value);
    max = std::max(max, bar.value);
  }
  return axis.is_logarithmic && max > 0 ? logarithmic_scale(min, max)
                                        : linear_scale(max, kTickSpacing_px / length_px);
}

}  // namespace

std::string bar_chart(const std::vector<ChartBar>& bars, const BarAxis& axis) {
  double label_px = 0, value_px = 0;
  for (const ChartBar& bar : bars) {
    label_px = std::max(label_px, text_width_px(bar.label, kChartFont_px));
    value_px = std::max(value_px, text_width_px(bar.value_text, kChartFont_px));
  }
  const double left = std::min(label_px, kMaxLabel_px) + 14,
               length = std::max(kWidth_px - left - value_px - 20, kMinBarRoom_px),
               bottom = 4 + kRow_px * static_cast<double>(bars.size());
  const Scale scale = scale_of(bars, axis, length);
  std::string grid, svg;
  for (const double mark : scale.marks) {
    const double x = left + length * scale.share(mark);
    grid += fmt::format("M{:.1f} 4V{:.1f}", x, bottom);
    svg += svg_text({x, bottom + 16}, scale.label(mark), fmt::format("text-anchor='middle' {}", kTick));
  }
  svg = fmt::format("<path d='{}' {}/>\n", grid, kGrid) + svg;
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const ChartBar& bar = bars[i];
    const double top = 4 + kRow_px * static_cast<double>(i), text_y = top + kRow_px / 2 + 4.5;
    const double bar_px = length * std::clamp(scale.share(bar.value), 0.0, 1.0);
    svg += svg_text({left - 8, text_y}, bar.label, "text-anchor='end'") +
           fmt::format("<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.0f}' fill='{}'/>\n", left,
                       top + (kRow_px - kBar_px) / 2, bar_px, kBar_px, bar.colour) +
           svg_text({left + bar_px + 6, text_y}, bar.value_text, "");
  }
  svg += svg_text({left + length / 2, bottom + 34}, axis.label, "text-anchor='middle'");
  return chart(bottom + kAxisBottom_px, svg);
}

std::string line_chart(const std::vector<ChartLine>& lines, const LineAxes& axes) {
  double min_x = std::numeric_limits<double>::infinity(), max_x = -min_x, max_y = axes.marked_y.value_or(0);
  for (const ChartLine& line : lines)
    for (const Vec2& p : line.points) {
      min_x = std::min(min_x, p.x());
      max_x = std::max(max_x, p.x());
      max_y = std::max(max_y, p.y());
    }
  if (!(min_x < max_x)) return {};
  const double width = kWidth_px - kPlotLeft_px - kPlotRight_px, bottom = kPlotTop_px + kPlotHeight_px;
  const Scale y_scale = linear_scale(max_y, 50 / kPlotHeight_px);
  const auto x = [&](double value) { return kPlotLeft_px + width * (value - min_x) / (max_x - min_x); };
  const auto y = [&](double value) { return bottom - kPlotHeight_px * y_scale.share(value); };
  std::string grid, svg;
  for (const double mark : y_scale.marks) {
    grid += fmt::format("M{:.1f} {:.1f}h{:.1f}", kPlotLeft_px, y(mark), width);
    svg += svg_text({kPlotLeft_px - 6, y(mark) + 4}, y_scale.label(mark),
                    fmt::format("text-anchor='end' {}", kTick));
  }
  const double x_step = round_step((max_x - min_x) * kTickSpacing_px / width);
  for (const double mark : ticks(min_x, max_x, x_step)) {
    grid += fmt::format("M{:.1f} {:.1f}V{:.1f}", x(mark), kPlotTop_px, bottom);
    svg += svg_text({x(mark), bottom + 16}, tick_label(mark, x_step),
                    fmt::format("text-anchor='middle' {}", kTick));
  }
  svg = fmt::format("<path d='{}' {}/>\n", grid, kGrid) + svg;
  for (const ChartLine& line : lines) {
    std::vector<Vec2> points;
    for (const Vec2& p : line.points) points.emplace_back(x(p.x()), y(p.y()));
    svg += fmt::format("<path d='{}' fill='none' stroke='{}' stroke-width='1.8'><title>{}</title></path>\n",
                       svg_path_data(points), line.colour, xml_escaped(line.label));
  }
  if (axes.marked_y) {
    svg += fmt::format(
               "<path d='M{:.1f} {:.1f}h{:.1f}' stroke='currentColor' stroke-opacity='0.7' "
               "stroke-dasharray='6 4'/>\n",
               kPlotLeft_px, y(*axes.marked_y), width) +
           svg_text({kPlotLeft_px + width - 4, y(*axes.marked_y) - 5}, axes.mark_label, "text-anchor='end'");
  }
  svg +=
      svg_text({kPlotLeft_px + width / 2, bottom + 34}, axes.x_label, "text-anchor='middle'") +
      fmt::format("<g transform='translate(14,{:.0f}) rotate(-90)'>{}</g>\n",
                  kPlotTop_px + kPlotHeight_px / 2, svg_text({0, 0}, axes.y_label, "text-anchor='middle'"));
  return chart(bottom + kAxisBottom_px, svg);
}

}  // namespace sidestep
