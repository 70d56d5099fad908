// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "agents/planning/domain/disc_domain.hpp"
#include "agents/planning/domain/plan.hpp"

namespace sidestep {

/// Where a way goes from one cell into the next: the middle of the border that they share.
struct Portal {
  std::uint32_t a, b;  ///< cells
  Vec2 middle_m;

  std::uint32_t other(std::uint32_t cell) const { return cell == a ? b : a; }
};

/// Free convex cells and the portals between them.
struct CellGraph {
  std::vector<ConvexPolygon> cells;
  std::vector<Portal> portals;
};

/// The shortest way from portal to portal (A*); straight motions within a cell are free. A start or a goal
/// that lies in no cell is joined with the nearest that it sees. Keeps its memory.
class CellSearch {
 public:
  /// Fills the plan in, all but what is blocked; unreachable means through these cells.
  void plan(const CellGraph& graph, const DiscDomain& domain, const Vec2& start, const Budget& budget,
            Plan<Vec2>& plan);

 private:
  struct Open {
    double promise_m, cost_m;
    std::uint32_t portal;
    std::uint32_t cell;  // that it leads into
    std::uint32_t from;  // portal
  };
  /// A cell, and where a place outside of it enters it.
  struct Entry {
    std::uint32_t cell;
    Vec2 at_m;
  };

  void list_portals(const CellGraph& graph);
  std::optional<Entry> entry(const CellGraph& graph, const DiscDomain& domain, const Vec2& place) const;
  void look_into(const CellGraph& graph, std::uint32_t cell, std::uint32_t from, const Vec2& at,
                 double cost_m, const Vec2& goal);
  std::optional<std::uint32_t> search(const CellGraph& graph, const Entry& from, const Entry& to,
                                      const Budget& budget, Plan<Vec2>& plan);

  std::vector<std::uint32_t> first_, of_cell_;  // portals, by cell
  std::vector<std::uint32_t> came_from_;        // portal, by portal
  std::vector<Open> open_;
};

}  // namespace sidestep
