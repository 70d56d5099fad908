// SPDX-License-Identifier: Apache-2.0
#include "vision/segmentation/region_merging.hpp"

#include <algorithm>

namespace sidestep {
namespace {

/// Minimum fraction of the common bounding box that both regions fill together.
constexpr double kMinDensity = 0.5;

Region merged(const Region& a, const Region& b) {
  Region both = a;
  both.area_px = a.area_px + b.area_px;
  const double share = static_cast<double>(b.area_px) / both.area_px;
  both.x_px += (b.x_px - a.x_px) * share;
  both.y_px += (b.y_px - a.y_px) * share;
  both.left_px = std::min(a.left_px, b.left_px);
  both.right_px = std::max(a.right_px, b.right_px);
  both.top_px = std::min(a.top_px, b.top_px);
  both.bottom_px = std::max(a.bottom_px, b.bottom_px);
  return both;
}

double density(const Region& region) {
  const double width = region.right_px - region.left_px + 1, height = region.bottom_px - region.top_px + 1;
  return region.area_px / (width * height);
}

bool is_absorbed(const Region& region) { return region.area_px == 0; }

/// Whether `lower` has the colour of `upper` and starts at most `max_gap_px` rows below it. If false, it is
/// also false for all later regions.
bool is_within_rows(const Region& upper, const Region& lower, int max_gap_px) {
  return lower.colour == upper.colour && lower.top_px - upper.bottom_px - 1 <= max_gap_px;
}

bool is_within_columns(const Region& a, const Region& b, int max_gap_px) {
  return std::max(a.left_px, b.left_px) - std::min(a.right_px, b.right_px) - 1 <= max_gap_px;
}

}  // namespace

void merge_by_density(std::vector<Region>& regions, int max_gap_px) {
  if (max_gap_px < 0) return;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    if (is_absorbed(regions[i])) continue;
    std::size_t j = i + 1;
    while (j < regions.size() && is_within_rows(regions[i], regions[j], max_gap_px)) {
      const Region both = merged(regions[i], regions[j]);
      if (is_absorbed(regions[j]) || !is_within_columns(regions[i], regions[j], max_gap_px) ||
          density(both) < kMinDensity) {
        ++j;
        continue;
      }
      regions[i] = both;
      regions[j].area_px = 0;
      j = i + 1;  // regions skipped earlier may fit the larger region
    }
  }
  std::erase_if(regions, is_absorbed);
}

}  // namespace sidestep
