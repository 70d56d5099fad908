// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/grids/navigation/cost_grid.hpp"

namespace sidestep {

/// A person or other moving object: a disc with a position at time 0 and a constant velocity.
struct MovingDisc {
  Vec2 position_m{0, 0}, velocity_mps{0, 0};
  double radius_m = 0.3;
};

struct RiskSettings {
  double robot_speed_mps = 1;  ///< speed of the robot, to estimate when it reaches a cell
  double cost = 20;            ///< cost added to a cell that robot and disc certainly occupy at the same time
};

/// Adds the risk of meeting moving discs to the costs of a grid (the co-occurrence of Philippsen, Kolski,
/// Macek, Jensfelt 2008, with discs instead of distributions over cells). A disc enlarged by the robot's
/// radius covers a cell's centre during an interval of time. The risk is 1 if the robot, driving straight,
/// would arrive at the cell within this interval. Otherwise it decreases like a normal distribution with the
/// time between the arrival and the interval. Without discs the costs are exactly the costs of the grid.
/// Throws std::invalid_argument for invalid settings, discs, positions and identifiers.
class RiskLayer {
 public:
  static constexpr double kRobotRadius_m = 0.25;
  static constexpr double kHorizon_s = 5;  ///< time for which the disc is predicted to keep its velocity
  static constexpr double kSpread_s = 1;   ///< standard deviation of the robot's time of arrival at a cell

  explicit RiskLayer(const CostGrid& grid, const RiskSettings& settings = {});

  /// Adds a disc, as seen by a robot at a position, and returns its identifier.
  std::uint32_t add(const MovingDisc& disc, const Vec2& robot_m);
  void remove(std::uint32_t id);
  /// The cells whose cost the last call of add() or remove() changed.
  const std::vector<GridCell>& changed() const { return changed_; }
  /// The cost with all risks; blocked cells stay blocked.
  float cost(GridCell cell) const;

 private:
  struct Risk {
    GridCell cell;
    float cost;
  };
  struct Layer {
    std::uint32_t id;
    std::vector<Risk> risks;  // indexed by cell
  };

  float risk_cost(const MovingDisc& disc, const Vec2& robot_m, const Vec2& cell_m) const;

  CostGrid grid_;
  RiskSettings settings_;
  std::vector<Layer> layers_;  // indexed by disc id
  std::vector<GridCell> changed_;
  std::uint32_t next_id_ = 0;
};

}  // namespace sidestep
