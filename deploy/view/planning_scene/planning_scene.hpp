// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "agents/planning/domain/disc_domain.hpp"
#include "agents/planning/roadmaps/prm.hpp"
#include "agents/planning/trees/errt.hpp"
#include "common/geometry/circle.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// A floor on which a person drags obstacles, start and goal, while a planner plans again after each change:
/// Dynamic PRM, whose roadmap repairs itself (Bruce 2006, section 4.4 and figure 4.10), or ERRT, which keeps
/// waypoints from its last plan.
class PlanningScene {
 public:
  static constexpr std::size_t kMaxObstacles = 60;
  static constexpr double kLength_m = 9, kWidth_m = 6, kRadius_m = 0.09;

  explicit PlanningScene(std::uint64_t seed = 1);

  /// Changes the scene as a message requests, and plans: {"op": "move", "what": "start", "goal" or the number
  /// of an obstacle, "x": …, "y": …}, {"op": "scene", "seed": …, "obstacles": …}, {"op": "planner", "name":
  /// "dynamic-prm" or "errt"}. False: the message is invalid, and nothing has changed.
  [[nodiscard]] bool apply(const nlohmann::json& message);

  /// {"type": "plan", "planner":…, "solved":…, "length_m":…, "time_us":…, "start", "goal": [x, y],
  /// "obstacles": [[x, y, radius], …], "path": [[x, y], …], "nodes": [[x, y], …], "edges": [[node, node,
  /// state], …]}; states: 0 blocked, 1 free, 2 not checked since the scene has changed.
  [[nodiscard]] nlohmann::ordered_json json() const;

 private:
  void sample(std::uint64_t seed, std::size_t obstacles);
  void plan();
  DiscDomain domain() const;

  std::string planner_ = "dynamic-prm";
  std::vector<Circle> obstacles_;
  ObstacleWorld world_;
  Vec2 start_m_{-4, 0}, goal_m_{4, 0};
  Prm<DiscDomain> prm_{dynamic_prm()};
  Errt<DiscDomain> errt_;
  Rng rng_;
  Plan<Vec2> plan_;
  double time_us_ = 0;
};

}  // namespace sidestep
