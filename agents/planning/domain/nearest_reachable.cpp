// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/domain/nearest_reachable.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace sidestep {
namespace {

constexpr double kMaxCells = 4000;
// Number of nearest cells from which positions slide towards the goal.
constexpr std::size_t kRefinedCells = 4;
constexpr int kDirections = 16;
constexpr double kMinStep_m = 0.001;

/// The positions reached by a flood fill from a free position, on a grid around it.
std::vector<Vec2> flood(const DiscDomain& domain, const Vec2& origin, double spacing) {
  const Field& field = domain.field();
  const int half_columns = static_cast<int>(field.length_m / spacing) + 1;
  const int half_rows = static_cast<int>(field.width_m / spacing) + 1;
  const int columns = 2 * half_columns + 1, rows = 2 * half_rows + 1;
  std::vector<bool> is_reached(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  std::vector<std::pair<int, int>> cells{{0, 0}};
  std::vector<Vec2> positions{origin};
  const auto reach = [&](int column, int row) {
    return is_reached[static_cast<std::size_t>((row + half_rows) * columns + column + half_columns)];
  };
  reach(0, 0) = true;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto [column, row] = cells[i];
    const Vec2 from = positions[i];
    for (const auto& [x, y] :
         {std::pair{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}) {
      if (std::abs(column + x) > half_columns || std::abs(row + y) > half_rows) continue;
      if (reach(column + x, row + y)) continue;
      const Vec2 to = origin + spacing * Vec2(column + x, row + y);
      if (!domain.check(from, to)) continue;
      reach(column + x, row + y) = true;
      cells.emplace_back(column + x, row + y);
      positions.push_back(to);
    }
  }
  return positions;
}

/// Moves a position nearer to the goal in ever smaller steps.
Vec2 slide(const DiscDomain& domain, Vec2 position, const Vec2& goal, double step) {
  while (step >= kMinStep_m) {
    const Vec2 ahead = (goal - position).stableNormalized();
    Vec2 best = position;
    for (int i = 0; i < kDirections; ++i) {
      const Vec2 next = position + step * rotated(ahead, i * 2 * std::numbers::pi / kDirections);
      if ((next - goal).norm() < (best - goal).norm() - kMinStep_m / 10 && domain.check(position, next))
        best = next;
    }
    if (best == position)
      step /= 2;
    else
      position = best;
  }
  return position;
}

}  // namespace

std::optional<Vec2> nearest_reachable(const DiscDomain& domain, const Vec2& start, const Vec2& goal) {
  const std::optional<Vec2> origin = domain.start_is_blocked() ? domain.exit() : std::optional(start);
  if (!origin) return std::nullopt;
  const Field& field = domain.field();
  const double spacing = std::max(domain.radius_m(), std::sqrt(field.length_m * field.width_m / kMaxCells));
  std::vector<Vec2> reached = flood(domain, *origin, spacing);
  const auto to_goal = [&](const Vec2& position) { return (position - goal).squaredNorm(); };
  const std::size_t count = std::min(reached.size(), kRefinedCells);
  std::ranges::partial_sort(reached, reached.begin() + static_cast<std::ptrdiff_t>(count), {}, to_goal);
  reached.resize(count);
  for (Vec2& position : reached) position = slide(domain, position, goal, spacing / 2);
  return *std::ranges::min_element(reached, {}, to_goal);
}

}  // namespace sidestep
