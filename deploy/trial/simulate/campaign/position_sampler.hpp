// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/map/bit_grid.hpp"
#include "common/map/map_grid.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// Samples positions of robots clear of walls, of obstacles and, on request, of other positions. A robot can
/// drive from each position to every other, so none of them is in an enclosed pocket.
class PositionSampler {
 public:
  /// Both arguments must outlive the sampler.
  PositionSampler(const Scenario& scenario, Rng& rng);

  /// A position within the central `share` of the field if a free one is found there, otherwise anywhere.
  Vec2 sample(double share = 1);
  Vec2 sample_apart(const std::vector<Vec2>& others);
  /// A free position near the desired one and clear of `others`.
  Vec2 sample_near(const Vec2& desired, const std::vector<Vec2>& others);

 private:
  bool is_clear(const Vec2& p) const;
  bool is_free(const Vec2& p) const;
  /// Finds the cells of the largest part of the floor in which robots can drive.
  void find_largest_part();
  bool is_apart(const Vec2& p, const std::vector<Vec2>& others) const;

  const Scenario& scenario_;
  Rng& rng_;
  MapGrid grid_;
  std::optional<BitGrid> largest_part_;  ///< nullopt: the whole floor, which has neither obstacles nor walls
};

}  // namespace sidestep
