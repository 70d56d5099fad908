// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/proposal_search.hpp"

#include "agents/agent/planning_distances.hpp"
#include "agents/safety/escape_search.hpp"

namespace sidestep {

ProposalSearch::ProposalSearch(PlanningScratch& scratch)
    : scratch_(scratch), horizon_m_(search_horizon_m(scratch.rules)) {}

SearchResult ProposalSearch::find(const SearchQuery& query, const Version& base, const Neighbours& neighbours,
                                  Rng& rng) {
  TrajectoryIndex& others = scratch_.others;
  neighbours.collect(query.at_start.position_m, horizon_m_, others);
  SearchResult result = scratch_.safety_search.search(query, others, rng);
  const bool is_blocked = result.count == 0;
  if (is_blocked) result = search_escape(query, base, others, scratch_.rules);
  is_escaping_ = is_blocked && result.count > 0;
  return result;
}

}  // namespace sidestep
