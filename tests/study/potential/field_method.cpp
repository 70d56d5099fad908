// SPDX-License-Identifier: Apache-2.0
#include "tests/study/potential/field_method.hpp"

#include <fmt/format.h>
#include <memory>

#include "agents/navigation/potential_field/potential_field.hpp"
#include "agents/planning/grids/navigation/blocked_cells.hpp"
#include "agents/planning/grids/navigation/descent.hpp"

namespace sidestep {
namespace {

// Radius added to the planned disc, to leave room for overshooting in turns.
constexpr double kOvershoot_m = 0.04;
constexpr double kCell_m = 0.02;

auto free_distance(const ObstacleWorld& obstacles) {
  return DistanceFunction([&obstacles](const Vec2& p) { return obstacles.nearest(p).distance_m; });
}

DriveDirection down_the_potential(double rotation, const PlanWorld& world, const ObstacleWorld& obstacles) {
  PotentialFieldSettings settings;
  settings.rotation = rotation;
  return [field = PotentialField(world.radius_m, settings), free = free_distance(obstacles),
          goal = world.queries.front().goal_m](const Vec2& at) -> Vec2 {
    const Vec2 force = field.force(at, goal, free(at, 0));
    return force.norm() > 0 ? Vec2(force.normalized()) : Vec2(0, 0);
  };
}

DriveDirection down_the_function(GridKernel kernel, const PlanWorld& world, const ObstacleWorld& obstacles) {
  const Vec2 size(world.field.length_m, world.field.width_m);
  CostGrid grid({static_cast<std::uint32_t>(size.x() / kCell_m),
                 static_cast<std::uint32_t>(size.y() / kCell_m), kCell_m, -size / 2});
  for (const Shape& shape : world.obstacles) block_shape(grid, shape, world.radius_m + kOvershoot_m);
  const auto field = std::make_shared<EStar>(grid, EStarSettings{.kernel = kernel});
  field->set_goal(world.queries.front().goal_m);
  field->propagate();
  return
      [field, free = free_distance(obstacles), goal = world.queries.front().goal_m](const Vec2& at) -> Vec2 {
        const Vec2 direction = direction_at(*field, at);
        if (direction.norm() > 0) return direction;
        const auto cell = field->layout().cell_at(at);
        if (cell && !field->is_blocked(*cell)) return (goal - at).normalized();
        return free(at, 0).away;
      };
}

}  // namespace

std::string name_of(const FieldMethod& method) {
  if (method.kind == FieldMethod::Kind::kNf1) return "NF1";
  if (method.kind == FieldMethod::Kind::kEStar) return "E*";
  return method.rotation == 0 ? "potential" : fmt::format("rotation {}", method.rotation);
}

DriveDirection direction_of(const FieldMethod& method, const PlanWorld& world,
                            const ObstacleWorld& obstacles) {
  if (method.kind == FieldMethod::Kind::kPotential)
    return down_the_potential(method.rotation, world, obstacles);
  const GridKernel kernel = method.kind == FieldMethod::Kind::kNf1 ? GridKernel::kNf1 : GridKernel::kLsm;
  return down_the_function(kernel, world, obstacles);
}

}  // namespace sidestep
