// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "common/image/image.hpp"
#include "vision/colours/colour_learner.hpp"

namespace sidestep {

/// Calls on_disc(disc, x, y) for each pixel that shows nothing but a disc of `discs`, and on_ground(x, y) for
/// each that is near none of them; pixels near `unknown` are left out.
template <typename OnDisc, typename OnGround>
void for_known_pixels(const ImageView& image, std::span<const KnownDisc> discs,
                      std::span<const KnownDisc> unknown, OnDisc on_disc, OnGround on_ground) {
  std::vector<KnownDisc> here, unknown_here;
  const auto reaching = [](std::span<const KnownDisc> all, int y, std::vector<KnownDisc>& some) {
    some.clear();
    for (const KnownDisc& disc : all) {
      if (disc.is_near(static_cast<int>(std::lround(disc.centre_px.x())), y)) some.push_back(disc);
    }
  };
  const auto is_near_any = [](const std::vector<KnownDisc>& some, int x, int y) {
    return std::ranges::any_of(some, [&](const KnownDisc& disc) { return disc.is_near(x, y); });
  };
  for (int y = 0; y < image.height_px; ++y) {
    reaching(discs, y, here);
    reaching(unknown, y, unknown_here);
    for (int x = 0; x < image.width_px; ++x) {
      if (is_near_any(unknown_here, x, y)) continue;
      for (const KnownDisc& disc : here) {
        if (disc.is_inside(x, y)) on_disc(disc, x, y);
      }
      if (!is_near_any(here, x, y)) on_ground(x, y);
    }
  }
}

}  // namespace sidestep
