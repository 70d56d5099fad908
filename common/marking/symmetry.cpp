// SPDX-License-Identifier: Apache-2.0
#include "common/marking/symmetry.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

/// Where each dot goes, or nothing when one of them goes nowhere.
std::vector<std::size_t> turned_dots(const MarkingLayout& layout, double angle_rad) {
  std::vector<std::size_t> goes_to;
  for (const MarkingDot& dot : layout.dots) {
    const Vec2 there =
        layout.centre.position_m + rotated(dot.position_m - layout.centre.position_m, angle_rad);
    for (std::size_t j = 0; j < layout.dots.size(); ++j) {
      const MarkingDot& other = layout.dots[j];
      if ((other.position_m - there).norm() > kSameSpot_m) continue;
      if (std::abs(other.radius_m - dot.radius_m) > kSameSpot_m) continue;
      goes_to.push_back(j);
      break;
    }
  }
  return goes_to.size() == layout.dots.size() ? goes_to : std::vector<std::size_t>{};
}

}  // namespace

std::vector<DotTurn> turns_of(const MarkingLayout& layout) {
  std::vector<DotTurn> turns;
  if (layout.dots.empty()) return turns;
  const auto angle = [&](const MarkingDot& dot) {
    const Vec2 p = dot.position_m - layout.centre.position_m;
    return std::atan2(p.y(), p.x());
  };
  constexpr double kFull_rad = 6.283185307179586;
  for (const MarkingDot& dot : layout.dots) {
    const double angle_rad = &dot == &layout.dots[0] ? 0 : angle(dot) - angle(layout.dots[0]);
    auto goes_to = turned_dots(layout, angle_rad);
    if (!goes_to.empty())
      turns.push_back({angle_rad < 0 ? angle_rad + kFull_rad : angle_rad, std::move(goes_to)});
  }
  std::sort(turns.begin(), turns.end(),
            [](const DotTurn& a, const DotTurn& b) { return a.angle_rad < b.angle_rad; });
  return turns;
}

std::size_t differences(const std::vector<Colour>& pattern, const std::vector<Colour>& turned,
                        const DotTurn& turn) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < turn.goes_to.size(); ++i) count += pattern[turn.goes_to[i]] != turned[i];
  return count;
}

}  // namespace sidestep
