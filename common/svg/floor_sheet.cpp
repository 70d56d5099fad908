// SPDX-License-Identifier: Apache-2.0
#include "common/svg/floor_sheet.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "common/svg/axis.hpp"
#include "common/svg/svg.hpp"

namespace sidestep {
namespace {

constexpr double kMaxWidth_px = 1130, kMaxHeight_px = 820;
constexpr double kLeft_px = 48, kTop_px = 60, kRight_px = 22, kAxis_px = 30;
constexpr double kMinWidth_px = 620;  // of a sheet
constexpr double kWideAspect = 0.9;   // height over width of a floor that is not wide
constexpr double kColumn_px = 300;    // width of a legend beside the floor
constexpr double kLegendRow_px = 26, kSheetFont_px = 13, kGap_px = 20;
constexpr double kScaleBar_px = 60;  // minimum length
constexpr const char* kQuiet = "fill='#57606a' font-size='11'";

std::string grid(const FloorView& view) {
  const Box& part = view.part_m;
  const double step = round_step(kTickSpacing_px / view.pixels_per_metre);
  const Vec2 corner = view.corner_px, size = view.size_px();
  std::string lines, labels;
  for (const double x_m : ticks(part.min_m.x(), part.max_m.x(), step)) {
    const double x = view.px(Vec2(x_m, 0)).x();
    lines += fmt::format("M{:.1f} {:.1f}v{:.1f}", x, corner.y(), size.y());
    labels += svg_text({x, corner.y() + size.y() + 16}, tick_label(x_m, step),
                       fmt::format("text-anchor='middle' {}", kQuiet));
  }
  for (const double y_m : ticks(part.min_m.y(), part.max_m.y(), step)) {
    const double y = view.px(Vec2(0, y_m)).y();
    lines += fmt::format("M{:.1f} {:.1f}h{:.1f}", corner.x(), y, size.x());
    labels +=
        svg_text({corner.x() - 6, y + 4}, tick_label(y_m, step), fmt::format("text-anchor='end' {}", kQuiet));
  }
  return fmt::format(
             "<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' fill='#f6f8fa'/>\n"
             "<path d='{}' stroke='#dde2e7' fill='none'/>\n",
             corner.x(), corner.y(), size.x(), size.y(), lines) +
         labels;
}

LegendEntry scale_bar(const FloorView& view) {
  const double length_m = round_step(kScaleBar_px / view.pixels_per_metre), length_px = view.px(length_m);
  return {fmt::format("<path d='M1 4v10M1 9h{0:.1f}M{1:.1f} 4v10' stroke='#1f2328' stroke-width='2' "
                      "fill='none'/>",
                      length_px, length_px + 1),
          tick_label(length_m, length_m) + " m", length_px + 8};
}

double width_of(const LegendEntry& entry) {
  return entry.symbol_px + text_width_px(entry.text, kSheetFont_px) + kGap_px;
}

std::string drawn(const LegendEntry& entry, const Vec2& at_px) {
  return fmt::format("<g transform='translate({:.1f},{:.1f})'>{}</g>\n", at_px.x(), at_px.y(), entry.symbol) +
         svg_text({at_px.x() + entry.symbol_px, at_px.y() + 13.5}, entry.text, "");
}

struct DrawnLegend {
  std::string svg;
  double bottom_px;
};

/// Arranges the entries in rows that are at most `width_px` wide.
DrawnLegend legend(const std::vector<LegendEntry>& entries, const Vec2& corner_px, double width_px) {
  DrawnLegend result{"", corner_px.y() + kLegendRow_px};
  Vec2 at_px = corner_px;
  for (const LegendEntry& entry : entries) {
    if (at_px.x() > corner_px.x() && at_px.x() + width_of(entry) > corner_px.x() + width_px + kGap_px) {
      at_px = {corner_px.x(), at_px.y() + kLegendRow_px};
      result.bottom_px += kLegendRow_px;
    }
    result.svg += drawn(entry, at_px);
    at_px.x() += width_of(entry);
  }
  return result;
}

}  // namespace

FloorView sheet_view(const Box& part_m) {
  const Vec2 size_m = (part_m.max_m - part_m.min_m).cwiseMax(1e-6);
  return {part_m, std::min(kMaxWidth_px / size_m.x(), kMaxHeight_px / size_m.y()), {kLeft_px, kTop_px}};
}

std::string svg_sheet(const FloorSheet& sheet) {
  const FloorView& view = sheet.view;
  const Vec2 size = view.size_px();
  std::vector<LegendEntry> entries{scale_bar(view)};
  entries.insert(entries.end(), sheet.legend.begin(), sheet.legend.end());
  // A floor that is not wide leaves room beside it.
  const bool is_beside = size.x() + kColumn_px < kMaxWidth_px && size.y() > kWideAspect * size.x();
  double width = kLeft_px + size.x() + kRight_px + (is_beside ? kColumn_px : 0);
  width = std::max({width, kMinWidth_px, kLeft_px + text_width_px(sheet.title, 17) + kRight_px,
                    kLeft_px + text_width_px(sheet.subtitle, kSheetFont_px) + kRight_px});
  double bottom = kTop_px + size.y() + kAxis_px;
  std::string strip;
  if (sheet.strip_px > 0) {
    strip = fmt::format("<g transform='translate({:.1f},{:.1f})'>{}</g>\n", kLeft_px, bottom, sheet.strip);
    bottom += sheet.strip_px;
  }
  const DrawnLegend drawn_legend =
      is_beside ? legend(entries, {kLeft_px + size.x() + 2 * kRight_px, kTop_px}, 0)
                : legend(entries, {kLeft_px, bottom + 4}, width - kLeft_px - kRight_px);
  bottom = std::max(bottom + 4, drawn_legend.bottom_px + 4);
  const std::string frame = fmt::format("x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}'", kLeft_px,
                                        kTop_px, size.x(), size.y());
  return svg_document(
      width, bottom,
      svg_text({kLeft_px, 26}, sheet.title, "font-size='17' font-weight='bold'") +
          svg_text({kLeft_px, 47}, sheet.subtitle, "fill='#57606a'") + grid(view) +
          fmt::format("<clipPath id='floor'><rect {0}/></clipPath>\n<g clip-path='url(#floor)'>\n{1}</g>\n"
                      "<rect {0} fill='none' stroke='#8b949e'/>\n",
                      frame, sheet.floor) +
          svg_text({kLeft_px - 6, kTop_px - 8}, "m", fmt::format("text-anchor='end' {}", kQuiet)) + strip +
          drawn_legend.svg);
}

LegendEntry dot_entry(const std::string& text, std::string_view attributes, double radius_px) {
  return {fmt::format("<path d='{}' {}/>", svg_ring_data({9, 9}, radius_px), attributes), text};
}

LegendEntry line_entry(const std::string& text, std::string_view attributes) {
  return {fmt::format("<path d='M0 9h20' fill='none' {}/>", attributes), text};
}

LegendEntry area_entry(const std::string& text, std::string_view attributes) {
  return {fmt::format("<path d='M1 2h18v14h-18z' {}/>", attributes), text};
}

}  // namespace sidestep
