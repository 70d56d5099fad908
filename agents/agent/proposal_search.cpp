// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/proposal_search.hpp"

#include <algorithm>
#include <span>

#include "agents/agent/planning_distances.hpp"
#include "agents/safety/creep_search.hpp"
#include "agents/safety/escape_search.hpp"

namespace sidestep {

ProposalSearch::ProposalSearch(PlanningScratch& scratch)
    : scratch_(scratch), horizon_m_(search_horizon_m(scratch.rules)) {}

SearchResult ProposalSearch::find(const SearchQuery& query, const Version& base, const Neighbours& neighbours,
                                  Rng& rng) {
  TrajectoryIndex& others = scratch_.others;
  neighbours.collect(query.at_start.position_m, horizon_m_, others);
  SearchQuery ordinary = query;
  ordinary.creep_mps = 0;  // a robot creeps only if it cannot move otherwise
  SearchResult result = scratch_.safety_search.search(ordinary, others, rng);
  const bool is_blocked = result.count == 0;
  if (is_blocked) result = search_escape(query, base, others, scratch_.rules);
  is_escaping_ = is_blocked && result.count > 0;
  if (result.count == 0) result = creep(query, others, rng);
  is_creeping_ = is_blocked && !is_escaping_ && result.count > 0;
  return result;
}

SearchResult ProposalSearch::creep(const SearchQuery& query, TrajectoryIndex& others, Rng& rng) {
  const CreepAccelerations creeps = accelerations_away(query, required_separation_m(scratch_.rules));
  const std::span<const Vec2> away = creeps.all();
  if (away.empty()) return {};
  SearchQuery creeping = query;
  creeping.desired_mps2 = away.front();
  creeping.preferred_mps2 = away;
  creeping.max_speed_mps = std::min(query.max_speed_mps, query.creep_mps);
  return scratch_.safety_search.search(creeping, others, rng);
}

}  // namespace sidestep
