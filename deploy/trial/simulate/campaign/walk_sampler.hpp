// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "agents/planning/named_planner.hpp"
#include "common/config/scenario.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// Samples places and walks of discs of one radius around the obstacles and walls of a scenario.
class WalkSampler {
 public:
  /// `rng` must outlive the sampler.
  WalkSampler(const Scenario& scenario, double radius_m, Rng& rng);

  [[nodiscard]] bool is_free(const Vec2& p) const {
    return field_.contains(p, radius_m_) && !world_.touches(p, radius_m_);
  }
  /// Whether a straight line crosses no obstacle.
  [[nodiscard]] bool is_seen(const Vec2& from_m, const Vec2& to_m) const {
    return !world_.touches(from_m, to_m, 0);
  }
  /// Samples a place where the disc touches nothing; nullopt if none was found.
  std::optional<Vec2> sample_free();
  /// The shortest path, without its start; nullopt if there is none.
  std::optional<std::vector<Vec2>> path(const Vec2& from_m, const Vec2& to_m);
  /// A walk from a place through random places along shortest paths. Unreachable places are left out.
  std::vector<Vec2> sample_walk(const Vec2& from_m, int places);

 private:
  Field field_;
  double radius_m_;
  Rng* rng_;
  NamedPlanner planner_;
  ObstacleWorld world_;
};

}  // namespace sidestep
