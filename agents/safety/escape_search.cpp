// SPDX-License-Identifier: Apache-2.0
#include "agents/safety/escape_search.hpp"

#include <algorithm>
#include <numbers>
#include <vector>

#include "common/motion/clearance.hpp"
#include "common/motion/escape.hpp"
#include "common/motion/robot_model.hpp"

namespace sidestep {
namespace {

/// Another robot's version, and how near to it a candidate may come.
struct Other {
  const Trajectory* trajectory;
  double kept_m;
};

struct Surroundings {
  std::vector<Other> others;
  bool is_too_near = false;
  Vec2 away{0, 0};  // from those that are
};

Surroundings surroundings_of(const SearchQuery& query, const Version& base, const TrajectoryIndex& others,
                             const FloorRules& rules) {
  Surroundings found;
  const Vec2& here = query.at_start.position_m;
  const double reach = reach_m(accelerate_then_stop(query.start, query.at_start, Vec2::Zero(), query.phase,
                                                    rules.limits.deceleration_mps2)) +
                       rules.limits.speed_mps * to_seconds(query.phase);
  for (std::size_t i = 0; i < others.size(); ++i) {
    const Version& other = others.version(i);
    const double keep = rules.min_separation_m() + query.inflation_m + other.inflation_m;
    const double far = reach + keep + reach_m(other.trajectory);
    if ((other.trajectory.at_start().position_m - here).squaredNorm() > far * far) continue;
    const double kept = kept_distance_m(base.trajectory, query.start, other.trajectory, keep);
    found.others.push_back({&other.trajectory, kept});
    if (kept == keep) continue;
    found.is_too_near = true;
    found.away += (here - other.trajectory.rest_position_m()).stableNormalized();
  }
  const Version rest{
      base.robot,   base.incarnation, base.number, base.base, rest_of(base.trajectory, query.start),
      query.inflation_m};
  FloorRules grown = rules;
  grown.margin_m += query.inflation_m;
  if (check_place(rest.trajectory, grown) != msg::REASON_GRANTED) {
    found.is_too_near = true;
    found.away -= here.stableNormalized();  // the field's middle is as good a direction as any
  }
  return found;
}

}  // namespace

SearchResult search_escape(const SearchQuery& query, const Version& base, const TrajectoryIndex& others,
                           const FloorRules& rules) {
  SearchResult result;
  const Surroundings around = surroundings_of(query, base, others, rules);
  if (!around.is_too_near) return result;
  const auto consider = [&](const Vec2& desired) {
    if (result.count == SearchResult::kMaxCandidates) return;
    const Vec2 acceleration = limited(desired, query.at_start.velocity_mps, rules.limits, query.phase);
    const Trajectory trajectory = accelerate_then_stop(query.start, query.at_start, acceleration, query.phase,
                                                       rules.limits.deceleration_mps2);
    const Version candidate{base.robot,  base.incarnation, base.number + 1,
                            base.number, trajectory,       query.inflation_m};
    if (trajectory.residual_speed_mps() > 1e-6 ||
        trajectory.rest_position_m() == base.trajectory.rest_position_m())
      return;
    result.checks += static_cast<int>(around.others.size());
    if (!rests_before_all(trajectory, query.moving, rules.radius_m + rules.margin_m + query.inflation_m)) return;
    if (check_place_after(candidate, base.trajectory, rules) != msg::REASON_GRANTED) return;
    const bool is_clear_of_all = std::ranges::all_of(around.others, [&](const Other& other) {
      return is_clear(trajectory, *other.trajectory, other.kept_m);
    });
    if (is_clear_of_all) result.candidates[result.count++] = trajectory;
  };
  consider(query.desired_mps2);
  result.desired_is_clear = result.count == 1;
  const Vec2 away = rules.limits.acceleration_mps2 *
                    (around.away.isZero() ? Vec2(1, 0) : Vec2(around.away.stableNormalized()));
  for (const double eighths : {0, 1, -1, 2, -2, 3, -3, 4})
    consider(rotated(away, eighths * std::numbers::pi / 4));
  return result;
}

}  // namespace sidestep
