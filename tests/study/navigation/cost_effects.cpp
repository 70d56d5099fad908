// SPDX-License-Identifier: Apache-2.0
#include "tests/study/navigation/cost_effects.hpp"

#include <algorithm>

#include "agents/planning/grids/navigation/descent.hpp"
#include "agents/planning/grids/navigation/risk_layer.hpp"

namespace sidestep {
namespace {

const GridLayout kFloor{.columns = 200, .rows = 200, .resolution_m = 0.05, .origin_m = {-5, -5}};
const Vec2 kRobot_m{-4, 0.1}, kGoal_m{4, 0};
constexpr double kSpeed_mps = 1;

std::vector<Vec2> path_of(const CostGrid& grid) {
  EStar field(grid);
  field.set_goal(kGoal_m);
  field.propagate();
  std::vector<Vec2> path_m;
  if (!trace(field, kRobot_m, path_m)) path_m.clear();
  return path_m;
}

/// Measurements along a path, in steps of a millimetre.
struct PathMeasures {
  double length_m = 0, in_region_m = 0, clearance_m = std::numeric_limits<double>::infinity();
};

PathMeasures measure_path(const std::vector<Vec2>& path_m, double region_half_m, const MovingDisc& person,
                          double robot_radius_m) {
  constexpr double kStep_m = 1e-3;
  PathMeasures measures;
  for (std::size_t i = 1; i < path_m.size(); ++i) {
    const Vec2 leg = path_m[i] - path_m[i - 1];
    const double length_m = leg.norm();
    for (double along_m = 0; along_m < length_m; along_m += kStep_m) {
      const Vec2 at = path_m[i - 1] + along_m / length_m * leg;
      const double part_m = std::min(kStep_m, length_m - along_m);
      if (at.cwiseAbs().maxCoeff() < region_half_m) measures.in_region_m += part_m;
      const double time_s = (measures.length_m + along_m) / kSpeed_mps;
      const double apart_m = (person.position_m + time_s * person.velocity_mps - at).norm();
      measures.clearance_m = std::min(measures.clearance_m, apart_m - person.radius_m - robot_radius_m);
    }
    measures.length_m += length_m;
  }
  return measures;
}

}  // namespace

StudyTable cost_effects() {
  StudyTable table;
  table.name = "costs";
  table.columns = {"costs", "weight", "path_m", "in_region_m", "clearance_m"};
  table.plots = {
      {.title = "a region of 3 m", .x_label = "cost of the region", .y_label = "path [m]"},
      {.title = "a person who crosses", .x_label = "cost of meeting", .y_label = "[m]", .min_y = -1}};
  constexpr double kHalf_m = 1.5;
  PlotLine length{"path", {}}, inside{"inside the region", {}};
  for (const float weight : {1.0f, 1.1f, 1.2f, 1.3f, 1.5f, 2.0f, 4.0f}) {
    CostGrid grid(kFloor);
    for (GridCell cell = 0; cell < kFloor.size(); ++cell)
      if (kFloor.centre_of(cell).cwiseAbs().maxCoeff() < kHalf_m) grid.set_cost(cell, weight);
    const PathMeasures measures = measure_path(path_of(grid), kHalf_m, {}, 0);
    table.rows.push_back(cells("region", weight, fmt::format("{:.3f}", measures.length_m),
                               fmt::format("{:.3f}", measures.in_region_m), "-"));
    length.points.push_back(plot_point(static_cast<double>(weight), measures.length_m));
    inside.points.push_back(plot_point(static_cast<double>(weight), measures.in_region_m));
  }
  table.plots[0].lines = {length, inside};
  PlotLine path{"path, beyond 8 m", {}}, clearance{"clearance", {}};
  const MovingDisc person{.position_m = {0, -3.2}, .velocity_mps = {0, 0.8}, .radius_m = 0.3};
  for (const double weight : {0.0, 1.0, 2.0, 5.0, 10.0, 20.0, 40.0}) {
    const RiskSettings settings{.robot_speed_mps = kSpeed_mps, .cost = weight};
    RiskLayer layer(CostGrid(kFloor), settings);
    layer.add(person, kRobot_m);
    CostGrid grid(kFloor);
    for (GridCell cell = 0; cell < kFloor.size(); ++cell) grid.set_cost(cell, layer.cost(cell));
    const PathMeasures measures = measure_path(path_of(grid), 0, person, RiskLayer::kRobotRadius_m);
    table.rows.push_back(cells("person", weight, fmt::format("{:.3f}", measures.length_m), "-",
                               fmt::format("{:.3f}", measures.clearance_m)));
    path.points.push_back(plot_point(weight, measures.length_m - 8));
    clearance.points.push_back(plot_point(weight, measures.clearance_m));
  }
  table.plots[1].lines = {path, clearance};
  return table;
}

}  // namespace sidestep
