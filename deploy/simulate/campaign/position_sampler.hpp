// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/config/scenario.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// Samples positions of robots clear of walls, of obstacles and, on request, of other positions.
class PositionSampler {
 public:
  /// Both arguments must outlive the sampler.
  PositionSampler(const Scenario& scenario, Rng& rng) : scenario_(scenario), rng_(rng) {}

  /// Within the central `share` of the field if a free position is found there, else anywhere.
  Vec2 sample(double share = 1);
  Vec2 sample_apart(const std::vector<Vec2>& others);
  /// A free position near the desired one and clear of the others.
  Vec2 sample_near(const Vec2& desired, const std::vector<Vec2>& others);

 private:
  bool is_free(const Vec2& p) const;
  bool is_apart(const Vec2& p, const std::vector<Vec2>& others) const;

  const Scenario& scenario_;
  Rng& rng_;
};

}  // namespace sidestep
