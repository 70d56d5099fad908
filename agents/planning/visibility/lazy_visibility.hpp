// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/domain/disc_domain.hpp"
#include "agents/planning/domain/plan.hpp"
#include "agents/planning/visibility/bend.hpp"
#include "agents/planning/visibility/known_obstacles.hpp"

namespace sidestep {

struct LazyVisibilitySettings {
  /// Ways keep so much more from obstacles than they have to, so that rounding is no contact.
  double stand_off_m = 1e-4;
  double corner_rad = 0.35;  ///< by which the way turns at most, at one of its corners
};

/// The shortest way of a disc among obstacles: A* over the tangents between bends, where a tangent is only
/// checked when it is the most promising, and an obstacle counts only when one that promised more ran into
/// it. Few obstacles matter for a query, however many there are.
class LazyVisibility {
 public:
  explicit LazyVisibility(const LazyVisibilitySettings& settings = {}) : settings_(settings) {}

  /// The result is this planner's, until its next plan. Nothing in it is random. Unreachable means that no
  /// way keeps the stand-off.
  const Plan<Vec2>& plan(const DiscDomain& domain, const Vec2& start, const Budget& budget, Rng& rng);

  /// The straight parts of all ways that the last plan followed.
  std::vector<Segment> ways() const;

 private:
  /// A way to a bend, that arrives there along `along`.
  struct Arrival {
    std::uint32_t bend = 0;
    Side side = Side::kLeft;
    Vec2 along{0, 0};
    double cost_m = 0;       // up to where it touches the bend
    double turn_rad = 0;     // at the bend it comes from
    double corner_rad = 0;   // of corners there, at most; 0: the chord counts as the turn
    std::uint32_t before;    // the arrival there
    std::uint32_t previous;  // arrival at this bend and side
  };
  /// A way on from an arrival that is not checked yet, and what it costs to the goal, at least.
  struct Promise {
    double cost_m;
    std::uint32_t candidate;
  };
  struct CostsMore {
    bool operator()(const Promise& a, const Promise& b) const { return a.cost_m > b.cost_m; }
  };

  void plan_from(const DiscDomain& domain, const Vec2& start, const Budget& budget);
  void plan_out(const DiscDomain& domain, const Vec2& start, const Budget& budget);
  void begin(const DiscDomain& domain, const Vec2& start);
  bool search(const DiscDomain& domain, const Budget& budget);
  void propose_all(const DiscDomain& domain, std::uint32_t arrival, std::uint32_t first_bend);
  void propose(const DiscDomain& domain, std::uint32_t arrival, const Bend& from, std::uint32_t bend);
  void put(const Promise& promise);
  Promise take();
  /// Arcs instead of their chords; returns by how much the way is longer.
  double measure(Arrival& next) const;
  /// Whether who arrived before can go round to where the next would arrive, at no more cost.
  bool is_served(const DiscDomain& domain, const Arrival& next);
  /// Chooses the corners.
  bool is_free_round(const DiscDomain& domain, Arrival& next);
  /// Looks at the tangent.
  bool is_free_straight(const DiscDomain& domain, const Arrival& next);
  bool is_free_round(const DiscDomain& domain, const Arrival& at, double turn_rad, const Vec2& along,
                     double corner_rad);
  bool is_free(const DiscDomain& domain, const Vec2& from, const Vec2& to);
  /// Takes into account what stops a motion that nothing known does.
  void discover(const DiscDomain& domain, const Vec2& from, const Vec2& to);
  /// No way has to bend at a corner that lies in another obstacle, or outside of the field: it bends at that
  /// one's corners. Hides those of the last obstacle, whose bends are from `first_bend` on, and those that it
  /// hides.
  void hide_corners(const Field& field, std::size_t first_bend);
  void write_plan(std::uint32_t arrival);

  LazyVisibilitySettings settings_;
  std::vector<Bend> bends_;  // the start, the goal, and those of the obstacles known
  KnownObstacles known_;
  std::vector<std::uint8_t> is_hidden_;  // by bend: ways need not touch it
  std::vector<Arrival> arrivals_;        // that are reached
  std::vector<std::uint32_t> last_;      // arrival, by bend and side
  std::vector<Arrival> candidates_;
  std::vector<Promise> queue_;         // a heap
  std::vector<std::uint32_t> likely_;  // bends
  std::vector<Vec2> corners_;
  std::vector<std::uint32_t> way_;
  Plan<Vec2> plan_;
};

}  // namespace sidestep
