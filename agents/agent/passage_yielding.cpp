// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/passage_yielding.hpp"

#include <algorithm>
#include <limits>

#include "agents/agent/planning_distances.hpp"

namespace sidestep {
namespace {

// Where robots cannot pass each other, a robot has the right of way for the time that it needs to drive this
// far, plus a fixed time.
constexpr double kPassageDistance_m = 40, kPassageExtra_s = 10;
/// Longer trips of other robots are considered only up to the next waypoint.
constexpr double kLongestTrip_m = 20;

}  // namespace

PassageYielding::PassageYielding(const FloorRules& rules)
    : rules_(rules),
      passage_period_(from_seconds(kPassageExtra_s + kPassageDistance_m / rules.limits.speed_mps)),
      give_way_({rules.field, rules.radius_m, required_separation_m(rules), rules.min_separation_m()},
                {.give_up_after = passage_period_ * 2 / 3}) {}

void PassageYielding::update(Time now, Observations& observations, const Assignment& assignment,
                             const RouteToTarget& route, Rng& rng) {
  if (!assignment.goal() || assignment.report().progress.is_finished()) return give_way_.restart(now);
  const double remaining_m =
      route.has_route() ? remaining_to_goal_m_ : std::numeric_limits<double>::infinity();
  const RouteObstacles* obstacles = route.obstacles();
  if (!give_way_.track_progress(now, remaining_m) || !obstacles) return;
  if (give_way_.is_searching()) return give_way_.search(now, rng);
  give_way_.begin_search(now, observations.own().estimate().position_m,
                         others_in_passages(now, observations, assignment), obstacles->fixed_world());
}

void PassageYielding::on_route(const Route& route) {
  const bool leads_to_goal = !place_m() && route.reaches_goal;
  remaining_to_goal_m_ = leads_to_goal ? route.length_m : std::numeric_limits<double>::infinity();
}

std::optional<Blockage> PassageYielding::blockage() const {
  const auto other = give_way_.waits_for();
  if (!other) return std::nullopt;
  return Blockage{msg::BlockReason::BLOCK_PASSING_ROBOT, other->first, other->second, *place_m()};
}

std::vector<OtherRobot> PassageYielding::others_in_passages(Time now, Observations& observations,
                                                            const Assignment& assignment) const {
  std::vector<OtherRobot> others;
  for (const Version* version :
       observations.neighbours().newest(observations.own().estimate().position_m, page_horizon_m(rules_)))
    others.push_back(other_nearby(*version, now, assignment));
  for (const RobotId robot : give_way_.yields_to()) {
    const OtherAssignment orders = assignment.other(robot);
    const bool is_near = std::ranges::any_of(others, [=](const auto& other) { return other.id == robot; });
    if (!is_near && orders.has_drive_order && !orders.is_held) others.push_back({robot, false});
  }
  return others;
}

OtherRobot PassageYielding::other_nearby(const Version& version, Time now,
                                         const Assignment& assignment) const {
  OtherRobot other{version.robot, true, version.trajectory.rest_position_m()};
  const OtherAssignment orders = assignment.other(version.robot);
  if (!version.intent || orders.is_held) return other;
  other.goals_m = {version.intent->goal_m, version.intent->target_m};
  // A route across a large floor would take too long to plan.
  for (std::optional<Vec2>& goal : other.goals_m)
    if ((*goal - other.position_m).norm() > kLongestTrip_m) goal = version.intent->waypoint_m;
  other.has_right_of_way = assignment.yields_to({version.robot, orders.number}, now, passage_period_);
  return other;
}

}  // namespace sidestep
