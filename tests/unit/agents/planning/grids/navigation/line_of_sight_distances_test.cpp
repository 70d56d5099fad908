// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/navigation/descent.hpp"
#include "tests/catch.hpp"
#include "tests/unit/agents/planning/grids/navigation/random_grid.hpp"

namespace sidestep::sight_test {

/// Reference: checks straight motions between all cell corners against all blocked cells.
class AllPairs {
 public:
  AllPairs(const CostGrid& grid, const Vec2& goal_m)
      : grid_(grid), columns_(grid.layout().columns), rows_(grid.layout().rows) {
    nodes_.push_back(grid.layout().in_cells(goal_m));
    for (int y = 0; y <= rows_; ++y)
      for (int x = 0; x <= columns_; ++x)
        if (!is_pinched(x, y)) nodes_.push_back(Vec2(x, y));
    lengths_.assign(nodes_.size(), std::numeric_limits<double>::infinity());
    lengths_[0] = 0;
    for (bool changes = true; changes;) {
      changes = false;
      for (std::size_t a = 0; a < nodes_.size(); ++a) {
        if (std::isinf(lengths_[a])) continue;
        for (std::size_t b = 0; b < nodes_.size(); ++b) {
          const double length = lengths_[a] + (nodes_[a] - nodes_[b]).norm();
          if (!(length < lengths_[b] - 1e-9) || !is_clear(nodes_[a], nodes_[b])) continue;
          lengths_[b] = length;
          changes = true;
        }
      }
    }
  }

  double length(GridCell cell) const {
    const Vec2 from = grid_.layout().in_cells(grid_.layout().centre_of(cell));
    double shortest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      if (is_clear(from, nodes_[i])) shortest = std::min(shortest, lengths_[i] + (nodes_[i] - from).norm());
    return shortest;
  }

 private:
  bool is_blocked(int x, int y) const {
    return x < 0 || y < 0 || x >= columns_ || y >= rows_ ||
           grid_.is_blocked(static_cast<GridCell>(y * columns_ + x));
  }
  /// Whether two blocked cells meet at this corner.
  bool is_pinched(int x, int y) const {
    return (is_blocked(x, y) && is_blocked(x - 1, y - 1)) || (is_blocked(x - 1, y) && is_blocked(x, y - 1));
  }
  /// Whether a segment avoids the interior of a square: clipping it to the square leaves nothing or only part
  /// of the square's border.
  static bool avoids(const Vec2& a, const Vec2& b, int x, int y) {
    double first = 0, last = 1;
    const Vec2 along = b - a, low(x, y);
    for (int axis = 0; axis < 2; ++axis) {
      const double from = low[axis] - a[axis], to = from + 1;
      if (along[axis] == 0) {
        if (from >= 0 || to <= 0) return true;
        continue;
      }
      first = std::max(first, std::min(from / along[axis], to / along[axis]));
      last = std::min(last, std::max(from / along[axis], to / along[axis]));
    }
    return last - first < 1e-9;
  }
  bool is_clear(const Vec2& a, const Vec2& b) const {
    for (int y = 0; y < rows_; ++y)
      for (int x = 0; x < columns_; ++x)
        if (is_blocked(x, y) && !avoids(a, b, x, y)) return false;
    // A motion must not pass between two blocked cells that meet at a corner or share an edge.
    for (int y = 0; y <= rows_; ++y) {
      for (int x = 0; x <= columns_; ++x) {
        const Vec2 at(x, y);
        const double along = (at - a).dot(b - a),
                     across = (b - a).x() * (at - a).y() - (b - a).y() * (at - a).x();
        const bool is_inside =
            along > 1e-9 && along < (b - a).squaredNorm() - 1e-9 && std::abs(across) < 1e-9;
        if (is_inside && is_pinched(x, y)) return false;
      }
    }
    const bool is_on_line =
        (a.x() == b.x() && a.x() == std::floor(a.x())) || (a.y() == b.y() && a.y() == std::floor(a.y()));
    if (!is_on_line || a == b) return true;
    const Vec2 across = Vec2(a.y() - b.y(), b.x() - a.x()).normalized();
    for (double part = 0.25; part < (b - a).norm(); part += 0.5) {
      const Vec2 at = a + part * (b - a).normalized();
      const Vec2 left = at + 0.5 * across, right = at - 0.5 * across;
      if (is_blocked(static_cast<int>(std::floor(left.x())), static_cast<int>(std::floor(left.y()))) &&
          is_blocked(static_cast<int>(std::floor(right.x())), static_cast<int>(std::floor(right.y()))))
        return false;
    }
    return true;
  }

  const CostGrid& grid_;
  int columns_, rows_;
  std::vector<Vec2> nodes_;
  std::vector<double> lengths_;
};

CostGrid noise(Rng& rng, std::uint32_t columns, std::uint32_t rows, double blocked) {
  CostGrid grid({.columns = columns, .rows = rows, .resolution_m = 0.1, .origin_m = {-2, 1}});
  for (GridCell cell = 0; cell < grid.layout().size(); ++cell)
    if (rng.chance(blocked)) grid.block(cell);
  return grid;
}

LineOfSightDistances lengths_of(const CostGrid& grid, const Vec2& goal_m) {
  LineOfSightDistances lengths(grid.layout());
  for (GridCell cell = 0; cell < grid.layout().size(); ++cell) lengths.set_open(cell, !grid.is_blocked(cell));
  lengths.compute(grid.layout().in_cells(goal_m));
  return lengths;
}

TEST_CASE("line-of-sight distances equal those of a search over all straight motions between cell corners") {
  const double blocked = GENERATE(0.0, 0.1, 0.2, 0.4);
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(blocked, seed);
    Rng rng(seed);
    const auto columns = static_cast<std::uint32_t>(1 + rng.below(12));
    const auto rows = static_cast<std::uint32_t>(1 + rng.below(12));
    const CostGrid grid = noise(rng, columns, rows, blocked);
    const Vec2 anywhere = random_position(rng, grid.layout());
    const Vec2 goal = seed % 2 == 0 ? anywhere : grid.layout().centre_of(*grid.layout().cell_at(anywhere));
    if (grid.is_blocked(*grid.layout().cell_at(goal))) continue;
    const LineOfSightDistances lengths = lengths_of(grid, goal);
    const AllPairs reference(grid, goal);
    for (GridCell cell = 0; cell < grid.layout().size(); ++cell) {
      if (grid.is_blocked(cell)) continue;
      const double expected = reference.length(cell);
      CAPTURE(cell, expected, lengths.length(cell));
      if (std::isinf(expected))
        REQUIRE(std::isinf(lengths.length(cell)));
      else
        REQUIRE(lengths.length(cell) == Approx(expected).margin(1e-4));
    }
  }
}

TEST_CASE("line-of-sight paths are free and as long as stated") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const CostGrid grid = noise(rng, 60, 50, 0.2);
    const GridLayout& layout = grid.layout();
    const Vec2 goal = random_position(rng, layout);
    if (grid.is_blocked(*layout.cell_at(goal))) continue;
    const EStar field = propagated(grid, goal, {.kernel = GridKernel::kLineOfSight});
    std::vector<Vec2> path_m;
    for (GridCell cell = 0; cell < layout.size(); cell += 7) {
      if (grid.is_blocked(cell) || std::isinf(field.value(cell))) continue;
      CAPTURE(cell);
      REQUIRE(trace(field, layout.centre_of(cell), path_m));
      REQUIRE(path_m.back() == goal);
      double length_m = 0;
      for (std::size_t i = 1; i < path_m.size(); ++i) length_m += (path_m[i] - path_m[i - 1]).norm();
      const auto exact_m = static_cast<double>(field.exact_value(cell)) * layout.resolution_m;
      REQUIRE(length_m > exact_m - 1e-5);
      if (field.value(cell) == field.exact_value(cell)) REQUIRE(length_m == Approx(exact_m).margin(1e-5));
    }
  }
}

}  // namespace sidestep::sight_test
