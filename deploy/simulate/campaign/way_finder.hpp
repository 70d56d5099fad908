// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "agents/planning/named_planner.hpp"
#include "common/collision/obstacle_world.hpp"
#include "common/config/scenario.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// Samples free places, and plans ways around the obstacles of a scenario, for discs of one radius.
class WayFinder {
 public:
  /// `rng` must outlive this.
  WayFinder(const Scenario& scenario, double radius_m, Rng& rng);

  [[nodiscard]] bool is_free(const Vec2& p) const {
    return field_.contains(p, radius_m_) && !world_.touches(p, radius_m_);
  }
  [[nodiscard]] Vec2 sample_free();
  /// Whether a straight line crosses no obstacle.
  [[nodiscard]] bool is_seen(const Vec2& from_m, const Vec2& to_m) const {
    return !world_.touches(from_m, to_m, 0);
  }
  /// The shortest path, without its start; nullopt if there is none.
  [[nodiscard]] std::optional<std::vector<Vec2>> path(const Vec2& from_m, const Vec2& to_m);

 private:
  Field field_;
  double radius_m_;
  Rng* rng_;
  NamedPlanner planner_;
  ObstacleWorld world_;
};

}  // namespace sidestep
