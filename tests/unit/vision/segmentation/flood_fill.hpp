// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "vision/segmentation/colour_classes.hpp"
#include "vision/segmentation/region.hpp"

namespace sidestep {

/// Slow reference: classifies each pixel, and flood-fills a region from each pixel that is not in a region
/// yet.
inline std::vector<Region> flood_filled(const ImageView& image, const ColourClasses& classes,
                                        std::uint32_t min_area_px) {
  const int width = image.width_px, height = image.height_px;
  std::vector<int> colour(static_cast<std::size_t>(width * height), -1);
  const auto at = [&](int x, int y) -> int& { return colour[static_cast<std::size_t>(y * width + x)]; };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (const auto found = classes.colour_of(pixel_at(image, x, y))) at(x, y) = static_cast<int>(*found);
    }
  }
  struct Pixel {
    int x, y;
  };
  std::vector<Region> regions;
  std::vector<Pixel> pending;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int own = at(x, y);
      if (own < 0) continue;
      std::uint64_t sum_x = 0, sum_y = 0;
      Region region{static_cast<std::uint32_t>(own), 0, 0, 0, x, x, y, y};
      pending.push_back({x, y});
      at(x, y) = -1;
      while (!pending.empty()) {
        const Pixel p = pending.back();
        pending.pop_back();
        ++region.area_px;
        sum_x += static_cast<std::uint64_t>(p.x);
        sum_y += static_cast<std::uint64_t>(p.y);
        region.left_px = std::min(region.left_px, p.x);
        region.right_px = std::max(region.right_px, p.x);
        region.bottom_px = std::max(region.bottom_px, p.y);
        for (int j = std::max(0, p.y - 1); j <= std::min(height - 1, p.y + 1); ++j) {
          for (int i = std::max(0, p.x - 1); i <= std::min(width - 1, p.x + 1); ++i) {
            if (at(i, j) != own) continue;
            at(i, j) = -1;
            pending.push_back({i, j});
          }
        }
      }
      region.x_px = static_cast<double>(sum_x) / region.area_px;
      region.y_px = static_cast<double>(sum_y) / region.area_px;
      if (region.area_px >= min_area_px) regions.push_back(region);
    }
  }
  std::stable_sort(regions.begin(), regions.end(),
                   [](const Region& a, const Region& b) { return a.colour < b.colour; });
  return regions;
}

}  // namespace sidestep
