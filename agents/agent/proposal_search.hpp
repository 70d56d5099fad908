// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/agent/neighbours.hpp"
#include "agents/agent/planning_scratch.hpp"
#include "agents/safety/safety_search.hpp"

namespace sidestep {

/// Searches for the candidates of a proposal. Inputs: a desired motion, the version that it continues, and
/// the versions of nearby robots. Output: motions that are clear of these versions; if the robot is already
/// in a conflict, motions that resolve it; if strangers may already have reached the robot, motions that
/// creep away from them.
class ProposalSearch {
 public:
  /// `scratch` is working memory, and must outlive this object.
  explicit ProposalSearch(PlanningScratch& scratch);

  /// Finds no candidate if every motion would come too near to something; the robot then brakes.
  [[nodiscard]] SearchResult find(const SearchQuery& query, const Version& base, const Neighbours& neighbours,
                                  Rng& rng);
  /// Whether the last search has found only an escape from a conflict.
  bool is_escaping() const { return is_escaping_; }
  /// Whether the last search has found that the robot may only creep away from strangers.
  bool is_creeping() const { return is_creeping_; }

 private:
  /// Finds the motions by which a robot leaves the reach of strangers.
  SearchResult creep(const SearchQuery& query, TrajectoryIndex& others, Rng& rng);

  PlanningScratch& scratch_;
  double horizon_m_;
  bool is_escaping_ = false;
  bool is_creeping_ = false;
};

}  // namespace sidestep
