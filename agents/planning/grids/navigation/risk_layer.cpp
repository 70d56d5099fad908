// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/navigation/risk_layer.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace sidestep {
namespace {

struct Interval {
  double from_s, to_s;  // empty if from > to
};

/// When a disc with this radius covers a point, from time 0 to the horizon.
Interval time_covered(const MovingDisc& disc, double radius_m, const Vec2& point_m, double horizon_s) {
  const Vec2 off = disc.position_m - point_m;
  const double speed2 = disc.velocity_mps.squaredNorm(), outside = off.squaredNorm() - radius_m * radius_m;
  if (speed2 == 0) return outside <= 0 ? Interval{0, horizon_s} : Interval{1, 0};
  const double middle_s = -off.dot(disc.velocity_mps) / speed2;
  const double half2 = middle_s * middle_s - outside / speed2;
  if (half2 < 0) return {1, 0};
  const double half_s = std::sqrt(half2);
  return {std::max(middle_s - half_s, 0.0), std::min(middle_s + half_s, horizon_s)};
}

}  // namespace

RiskLayer::RiskLayer(const CostGrid& grid, const RiskSettings& settings) : grid_(grid), settings_(settings) {
  const auto is_positive = [](double x) { return x > 0 && std::isfinite(x); };
  if (!is_positive(settings.robot_speed_mps) || !(settings.cost >= 0 && settings.cost <= kMaxCost))
    throw std::invalid_argument("the settings of a risk layer must be positive and finite");
}

float RiskLayer::risk_cost(const MovingDisc& disc, const Vec2& robot_m, const Vec2& cell_m) const {
  const Interval covered = time_covered(disc, disc.radius_m + kRobotRadius_m, cell_m, kHorizon_s);
  if (covered.from_s > covered.to_s) return 0;
  const double arrival_s = (cell_m - robot_m).norm() / settings_.robot_speed_mps;
  const double off = std::max({covered.from_s - arrival_s, arrival_s - covered.to_s, 0.0}) / kSpread_s;
  return static_cast<float>(settings_.cost * std::exp(-off * off / 2));
}

std::uint32_t RiskLayer::add(const MovingDisc& disc, const Vec2& robot_m) {
  if (!disc.position_m.allFinite() || !disc.velocity_mps.allFinite() || !robot_m.allFinite() ||
      !(disc.radius_m >= 0) || !std::isfinite(disc.radius_m))
    throw std::invalid_argument("a moving disc and the robot need finite positions and velocities");
  const GridLayout& layout = grid_.layout();
  const Vec2 end_m = disc.position_m + kHorizon_s * disc.velocity_mps;
  const double reach_m = disc.radius_m + kRobotRadius_m;
  const Vec2 first = layout.in_cells(disc.position_m.cwiseMin(end_m) - Vec2(reach_m, reach_m));
  const Vec2 last = layout.in_cells(disc.position_m.cwiseMax(end_m) + Vec2(reach_m, reach_m));
  const auto clipped = [](double at, std::uint32_t count) {
    return static_cast<std::uint32_t>(std::clamp(std::floor(at), 0.0, static_cast<double>(count)));
  };
  Layer layer{next_id_++, {}};
  changed_.clear();
  for (std::uint32_t row = clipped(first.y(), layout.rows); row < clipped(last.y() + 1, layout.rows); ++row) {
    for (std::uint32_t column = clipped(first.x(), layout.columns);
         column < clipped(last.x() + 1, layout.columns); ++column) {
      const GridCell cell = layout.cell(column, row);
      const float risk = risk_cost(disc, robot_m, layout.centre_of(cell));
      if (risk > 0 && !grid_.is_blocked(cell)) layer.risks.push_back({cell, risk});
    }
  }
  for (const Risk& risk : layer.risks) changed_.push_back(risk.cell);
  layers_.push_back(std::move(layer));
  return layers_.back().id;
}

void RiskLayer::remove(std::uint32_t id) {
  const auto found =
      std::find_if(layers_.begin(), layers_.end(), [&](const Layer& layer) { return layer.id == id; });
  if (found == layers_.end()) throw std::invalid_argument("no such moving disc: " + std::to_string(id));
  changed_.clear();
  for (const Risk& risk : found->risks) changed_.push_back(risk.cell);
  layers_.erase(found);
}

float RiskLayer::cost(GridCell cell) const {
  float cost = grid_.cost(cell);
  for (const Layer& layer : layers_) {
    const auto at = std::lower_bound(layer.risks.begin(), layer.risks.end(), cell,
                                     [](const Risk& risk, GridCell other) { return risk.cell < other; });
    if (at != layer.risks.end() && at->cell == cell) cost += at->cost;
  }
  return std::isinf(cost) ? cost : std::min(cost, kMaxCost);
}

}  // namespace sidestep
