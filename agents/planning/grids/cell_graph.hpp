// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "agents/planning/domain/disc_domain.hpp"
#include "agents/planning/domain/plan.hpp"

namespace sidestep {

/// The point where paths pass from one cell into the next: the midpoint of their common border.
struct Portal {
  std::uint32_t a, b;  ///< the two cells
  Vec2 middle_m;

  std::uint32_t other(std::uint32_t cell) const { return cell == a ? b : a; }
};

/// Free convex cells and the portals between them.
struct CellGraph {
  std::vector<ConvexPolygon> cells;
  std::vector<Portal> portals;
};

/// The cells that contain a query's start and goal, if known.
struct CellLocations {
  std::optional<std::uint32_t> start, goal;
};

/// A path from cell to cell.
struct CellPath {
  struct Step {
    std::uint32_t portal;
    std::uint32_t cell;  ///< cell that it leads into
  };
  Vec2 from_m{0, 0}, to_m{0, 0};  ///< where the path starts in the first cell and ends in the last cell
  std::vector<Step> steps;
};

/// Finds the shortest path from portal to portal (A*); straight motions within a cell are free. A start or
/// goal outside all cells is joined to the nearest visible cell. Reuses its memory between queries.
class CellSearch {
 public:
  /// Fills in the plan, except its blocked flags. PlanReason::kUnreachable applies to these cells only.
  void plan(const CellGraph& graph, const DiscDomain& domain, const Vec2& start, const Budget& budget,
            Plan<Vec2>& plan, const CellLocations& locations = {});

  /// The path of the last plan, if it reaches the goal.
  const CellPath& path() const { return path_; }

 private:
  struct Open {
    double estimate_m, cost_m;
    std::uint32_t portal;
    std::uint32_t cell;  // the cell that the portal leads into
    std::uint32_t from;  // the previous portal
  };
  /// A cell, and the point at which a path from a position outside all cells enters it.
  struct Entry {
    std::uint32_t cell;
    Vec2 at_m;
  };

  void index_portals(const CellGraph& graph);
  std::optional<Entry> entry(const CellGraph& graph, const DiscDomain& domain, const Vec2& position,
                             const std::optional<std::uint32_t>& location) const;
  void expand(const CellGraph& graph, std::uint32_t cell, std::uint32_t from, const Vec2& at, double cost_m,
              const Vec2& goal);
  std::optional<std::uint32_t> search(const CellGraph& graph, const Entry& from, const Entry& to,
                                      const Budget& budget, Plan<Vec2>& plan);

  std::vector<std::uint32_t> first_portal_;  // indexed by cell: its first entry in portals_by_cell_
  std::vector<std::uint32_t> portals_by_cell_;
  std::vector<std::uint32_t> came_from_;   // indexed by portal: the previous portal
  std::vector<std::uint32_t> leads_into_;  // indexed by portal with a previous portal: the cell
  std::vector<Open> open_;
  CellPath path_;
};

}  // namespace sidestep
