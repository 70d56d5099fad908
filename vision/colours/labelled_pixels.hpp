// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "common/image/image.hpp"
#include "vision/colours/colour_learner.hpp"

namespace sidestep {

/// Calls on_disc(disc, x, y) for each pixel that lies entirely inside one of `discs`, and on_background(x, y)
/// for each pixel that is not near any of them. Skips pixels near one of `ignored`.
template <typename OnDisc, typename OnBackground>
void for_labelled_pixels(const ImageView& image, std::span<const LabelledDisc> discs,
                         std::span<const LabelledDisc> ignored, OnDisc on_disc, OnBackground on_background) {
  std::vector<LabelledDisc> discs_in_row, ignored_in_row;
  const auto select_row = [](std::span<const LabelledDisc> all, int y, std::vector<LabelledDisc>& selected) {
    selected.clear();
    for (const LabelledDisc& disc : all) {
      if (disc.is_near(static_cast<int>(std::lround(disc.centre_px.x())), y)) selected.push_back(disc);
    }
  };
  const auto is_near_any = [](const std::vector<LabelledDisc>& some, int x, int y) {
    return std::ranges::any_of(some, [&](const LabelledDisc& disc) { return disc.is_near(x, y); });
  };
  for (int y = 0; y < image.height_px; ++y) {
    select_row(discs, y, discs_in_row);
    select_row(ignored, y, ignored_in_row);
    for (int x = 0; x < image.width_px; ++x) {
      if (is_near_any(ignored_in_row, x, y)) continue;
      for (const LabelledDisc& disc : discs_in_row) {
        if (disc.is_inside(x, y)) on_disc(disc, x, y);
      }
      if (!is_near_any(discs_in_row, x, y)) on_background(x, y);
    }
  }
}

}  // namespace sidestep
