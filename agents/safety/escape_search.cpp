// SPDX-License-Identifier: Apache-2.0
#include "agents/safety/escape_search.hpp"

#include <algorithm>
#include <numbers>
#include <vector>

#include "common/motion/clearance.hpp"
#include "common/motion/escape.hpp"
#include "common/motion/rest.hpp"
#include "common/motion/robot_model.hpp"

namespace sidestep {
namespace {

/// Another robot's version, and the distance that a candidate must keep from it.
struct Other {
  const Trajectory* trajectory;
  double separation_m;
};

struct Surroundings {
  std::vector<Other> others;
  bool is_in_conflict = false;
  Vec2 away{0, 0};  // sum of unit vectors away from the conflicts
};

Surroundings find_surroundings(const SearchQuery& query, const Version& base, const TrajectoryIndex& others,
                               const FloorRules& rules) {
  Surroundings found;
  const Vec2& position = query.at_start.position_m;
  const double reach = reach_m(accelerate_then_stop(query.start, query.at_start, Vec2::Zero(),
                                                    query.hold_time, rules.limits.deceleration_mps2)) +
                       rules.limits.speed_mps * to_seconds(query.hold_time);
  for (std::size_t i = 0; i < others.size(); ++i) {
    const Version& other = others.version(i);
    const double full_separation = rules.min_separation_m() + other.inflation_m;
    const double max_distance = reach + full_separation + reach_m(other.trajectory);
    if ((other.trajectory.at_start().position_m - position).squaredNorm() > max_distance * max_distance)
      continue;
    const double separation =
        relaxed_separation_m(base.trajectory, query.start, other.trajectory, full_separation);
    found.others.push_back({&other.trajectory, separation});
    if (separation == full_separation) continue;
    found.is_in_conflict = true;
    found.away += (position - other.trajectory.rest_position_m()).stableNormalized();
  }
  if (check_workspace(remaining_trajectory(base.trajectory, query.start), rules) != Validity::kValid) {
    found.is_in_conflict = true;
    found.away -= position.stableNormalized();  // away from the edge: towards the centre of the field
  }
  return found;
}

}  // namespace

SearchResult search_escape(const SearchQuery& query, const Version& base, const TrajectoryIndex& others,
                           const FloorRules& rules) {
  SearchResult result;
  const Surroundings surroundings = find_surroundings(query, base, others, rules);
  if (!surroundings.is_in_conflict) return result;
  const double min_separation_m = rules.radius_m + rules.margin_m;
  const UncontrolledBodies uncontrolled(query.uncontrolled, query.stop, query.start);
  const auto try_acceleration = [&](const Vec2& desired) {
    if (result.count == SearchResult::kMaxCandidates) return;
    const Vec2 acceleration = limit_acceleration(desired, query.at_start.velocity_mps,
                                                 query.limited(rules.limits), query.hold_time);
    const Trajectory trajectory = accelerate_then_stop(query.start, query.at_start, acceleration,
                                                       query.hold_time, rules.limits.deceleration_mps2);
    const Version candidate{base.robot, base.incarnation, base.number + 1, base.number, trajectory};
    if (trajectory.residual_speed_mps() > kPlannedRest_mps ||
        trajectory.rest_position_m() == base.trajectory.rest_position_m())
      return;
    result.checks += static_cast<int>(surroundings.others.size());
    if (!uncontrolled.allow(trajectory, min_separation_m, rules.limits.deceleration_mps2)) return;
    if (!is_passively_safe_from_all(trajectory, query.moving, min_separation_m, query.creep_mps)) return;
    if (!is_passively_safe_from_unseen(trajectory, query.seen, min_separation_m)) return;
    if (!is_passively_safe_from_hidden(trajectory, query.hidden, min_separation_m)) return;
    if (check_workspace_with_escape(candidate, base.trajectory, rules) != Validity::kValid) return;
    const bool is_clear_of_all = std::ranges::all_of(surroundings.others, [&](const Other& other) {
      return is_clear(trajectory, *other.trajectory, other.separation_m);
    });
    if (is_clear_of_all) result.candidates[result.count++] = trajectory;
  };
  try_acceleration(query.desired_mps2);
  result.desired_is_clear = result.count == 1;
  const Vec2 away = rules.limits.acceleration_mps2 *
                    (surroundings.away.isZero() ? Vec2(1, 0) : Vec2(surroundings.away.stableNormalized()));
  for (const double eighth_turns : {0, 1, -1, 2, -2, 3, -3, 4})
    try_acceleration(rotated(away, eighth_turns * std::numbers::pi / 4));
  return result;
}

}  // namespace sidestep
