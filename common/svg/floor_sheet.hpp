// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/svg/floor_view.hpp"

namespace sidestep {

struct LegendEntry {
  std::string symbol;     ///< SVG; its upper left corner is the origin, its height 18 pixels
  std::string text;       ///< not escaped
  double symbol_px = 26;  ///< width of the symbol
};

/// A picture of a floor with a heading, coordinates in metres along the edges, a scale bar and a legend.
struct FloorSheet {
  FloorView view;                   ///< from sheet_view()
  std::string title, subtitle;      ///< not escaped
  std::string floor;                ///< SVG; what lies outside the view is cut off
  std::string strip;                ///< SVG below the floor; its upper left corner is the origin
  double strip_px = 0;              ///< height of the strip
  std::vector<LegendEntry> legend;  ///< without the scale bar
};

/// The view of a part of a floor on a sheet that fits on a screen.
[[nodiscard]] FloorView sheet_view(const Box& part_m);
[[nodiscard]] std::string svg_sheet(const FloorSheet& sheet);

// Symbols for legends.
[[nodiscard]] LegendEntry dot_entry(const std::string& text, std::string_view attributes,
                                    double radius_px = 7);
[[nodiscard]] LegendEntry line_entry(const std::string& text, std::string_view attributes);
[[nodiscard]] LegendEntry area_entry(const std::string& text, std::string_view attributes);

}  // namespace sidestep
