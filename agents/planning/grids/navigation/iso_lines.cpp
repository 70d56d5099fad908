// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/navigation/iso_lines.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace sidestep {
namespace {

/// Adds the lines of one triangle of centres.
void add_lines(const std::array<Vec2, 3>& at_m, const std::array<double, 3>& values, double spacing,
               std::vector<Segment>& lines) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  if (std::isinf(*high)) return;
  for (double level = spacing * (std::floor(*low / spacing) + 1); level <= *high; level += spacing) {
    std::array<Vec2, 3> ends{};
    std::size_t count = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t b = (a + 1) % 3;
      if ((values[a] < level) == (values[b] < level)) continue;
      const double part = (level - values[a]) / (values[b] - values[a]);
      ends[count++] = at_m[a] + part * (at_m[b] - at_m[a]);
    }
    if (count == 2) lines.push_back({ends[0], ends[1]});
  }
}

}  // namespace

std::vector<Segment> iso_lines(const EStar& field, double spacing_cells) {
  if (!(spacing_cells > 0) || !std::isfinite(spacing_cells))
    throw std::invalid_argument("the spacing of iso-lines must be positive");
  std::vector<Segment> lines;
  const GridLayout& layout = field.layout();
  const auto value = [&](GridCell cell) { return static_cast<double>(field.value(cell)); };
  for (std::uint32_t row = 0; row + 1 < layout.rows; ++row) {
    for (std::uint32_t column = 0; column + 1 < layout.columns; ++column) {
      const GridCell a = layout.cell(column, row), b = a + 1, c = a + layout.columns, d = c + 1;
      const Vec2 at_b = layout.centre_of(b), at_c = layout.centre_of(c);
      add_lines({layout.centre_of(a), at_b, at_c}, {value(a), value(b), value(c)}, spacing_cells, lines);
      add_lines({at_b, layout.centre_of(d), at_c}, {value(b), value(d), value(c)}, spacing_cells, lines);
    }
  }
  return lines;
}

}  // namespace sidestep
