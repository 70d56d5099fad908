// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/passage_yielding.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <limits>
#include <utility>

#include "agents/agent/planning_distances.hpp"

namespace sidestep {
namespace {

// Where robots cannot pass each other, a robot has the right of way for the time that it needs to drive this
// far, plus a fixed time.
constexpr double kPassageDistance_m = 40, kPassageExtra_s = 10;
/// An idle robot that has stepped aside in vain waits this long until it tries again, and twice as long each
/// further time.
constexpr Duration kFirstPause{30'000'000'000}, kLongestPause{600'000'000'000};
/// A robot at rest for longer than this may be waiting.
constexpr Duration kWaitsAfter{500'000'000};
/// So may one that has stayed near a place for this long: robots that push against each other are never at
/// rest.
constexpr Duration kStaysNearFor{2'000'000'000};
constexpr double kStays_m = 0.1;  ///< distance from that place
/// Interval between two looks of an idle robot for robots that wait.
constexpr Duration kLookPeriod{250'000'000};
/// Idle robots notice robots that wait for them at this distance. They may wait where the way is wider.
constexpr double kIdleView_m = 20;
/// Number of robots that idle robots consider: the nearest, then the nearest of those that wait.
constexpr std::size_t kMaxOthers = 32, kNearestOthers = 16;
/// An idle robot that heads for a place this far away, which is not its own, makes room for others.
constexpr double kMinLeaving_m = 0.1;
/// A goal this far from the target is another place. Positions in messages are rounded.
constexpr double kOtherPlace_m = 0.005;
/// Longer trips of other robots are considered only up to the next waypoint.
constexpr double kLongestTrip_m = 20;

}  // namespace

PassageYielding::PassageYielding(RobotId self, const FloorRules& rules)
    : self_(self),
      rules_(rules),
      passage_period_(from_seconds(kPassageExtra_s + kPassageDistance_m / rules.limits.speed_mps)),
      give_way_({rules.field, rules.radius_m, required_separation_m(rules), rules.min_separation_m()},
                {.give_up_after = passage_period_ * 2 / 3}) {}

void PassageYielding::update(Time now, const Vec2& home_m, Observations& observations,
                             const Assignment& assignment, RouteToTarget& route, Rng& rng) {
  const bool is_idle = !assignment.goal() || assignment.report().progress.is_finished();
  if (std::exchange(is_idle_, is_idle) != is_idle) {
    give_way_.restart(now);
    stays_.clear();
    waiting_.clear();
    looked_at_ = {};
  }
  home_m_ = home_m;
  observations.set_view(view_m());
  if (is_idle && std::chrono::abs(now - looked_at_) >= kLookPeriod) {
    looked_at_ = now;
    find_waiting(now, observations, assignment);
  }
  const bool is_paused = now < paused_until_ && paused_until_ - now <= pause_;
  if (is_idle && !give_way_.place_m() && (waiting_.empty() || is_paused)) return give_way_.restart(now);
  const double remaining_m =
      !is_idle && route.has_route() ? remaining_to_goal_m_ : std::numeric_limits<double>::infinity();
  if (!give_way_.track_progress(now, remaining_m)) return;
  if (give_way_.is_searching()) return search(now, rng);
  give_way_.begin_search(now, observations.own().estimate().position_m,
                         others_in_passages(now, observations, assignment), route.obstacles().fixed_world(),
                         is_idle ? std::optional(home_m) : std::nullopt);
}

void PassageYielding::search(Time now, Rng& rng) {
  const bool gave_way = place_m().has_value();
  give_way_.search(now, rng);
  if (give_way_.has_given_up()) {
    ignored_until_ = now + passage_period_;
    if (!is_idle_) return;
    pause_ = std::min(std::max(2 * pause_, kFirstPause), kLongestPause);
    paused_until_ = now + pause_;
  } else if (gave_way && !place_m()) {
    pause_ = {};  // the others have passed
  }
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
  const Vec2& position_m = observations.own().estimate().position_m;
  for (const Version* version : observations.neighbours().newest(position_m, view_m())) {
    OtherRobot& other = others.emplace_back(other_nearby(*version, now, assignment));
    other.waits = is_idle_ && waits(version->robot);
    if (!is_near(*version, observations) && !other.waits) other.has_right_of_way = other.returns = false;
  }
  if (is_idle_ && others.size() > kMaxOthers) {
    std::ranges::sort(others, {}, [&](const OtherRobot& other) {
      return std::pair((other.position_m - position_m).squaredNorm(), other.id);
    });
    std::ranges::stable_partition(others.begin() + kNearestOthers, others.end(), std::identity(),
                                  &OtherRobot::waits);
    others.resize(kMaxOthers);
  }
  for (OtherRobot& other : others)
    other.rests = other.waits || observations.neighbours().is_at_rest(other.id, now - kWaitsAfter);
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
  other.is_held = orders.is_held;
  if (orders.is_held || (!is_idle_ && !version.intent)) return other;
  if (version.intent) other.goals_m = {version.intent->goal_m, version.intent->target_m};
  // The intent may be older than the order.
  if (is_idle_ && orders.goal_m) other.goals_m[1] = orders.goal_m;
  other.end_m = other.goals_m[1];
  // A route across a large floor would take too long to plan.
  for (std::optional<Vec2>& goal : other.goals_m)
    if (goal && (*goal - other.position_m).norm() > kLongestTrip_m)
      goal = version.intent ? std::optional(version.intent->waypoint_m) : std::nullopt;
  if (!orders.has_drive_order) {
    const bool leaves = lets_out(version, now);
    if (leaves || !is_idle_) other.goals_m[1].reset();
    if (leaves) other.end_m.reset();  // it goes out of the way again later
    // Of two that are out of the way, the one comes back first whose place is not on the other's route.
    const bool waits_to_return =
        is_idle_ && !place_m() && has_no_way(version) && !wants_place_of_this_robot(version);
    other.has_right_of_way = leaves || waits_to_return;
    other.returns = is_idle_ && !other.has_right_of_way;
  } else if (is_idle_) {
    other.has_right_of_way = true;
  } else {
    other.has_right_of_way = assignment.yields_to({version.robot, orders.number}, now, passage_period_);
  }
  return other;
}

bool PassageYielding::has_no_way(const Version& version) {
  return version.intent && (version.intent->goal_m - version.intent->target_m).norm() >= kOtherPlace_m;
}

bool PassageYielding::is_leaving(const Version& version) {
  return has_no_way(version) &&
         (version.intent->goal_m - version.trajectory.rest_position_m()).norm() >= kMinLeaving_m;
}

bool PassageYielding::lets_out(const Version& version, Time now) const {
  // Of two that both make room, one has to be first.
  if (is_idle_) return is_leaving(version) && !(place_m() && version.robot > self_);
  return is_leaving(version) && (now >= ignored_until_ || ignored_until_ - now > passage_period_);
}

bool PassageYielding::wants_place_of_this_robot(const Version& version) const {
  return version.intent && (version.intent->target_m - home_m_).norm() < rules_.min_separation_m();
}

void PassageYielding::find_waiting(Time now, Observations& observations, const Assignment& assignment) {
  const std::vector<Stay> before = std::exchange(stays_, {});
  waiting_.clear();
  for (const Version* version :
       observations.neighbours().newest(observations.own().estimate().position_m, view_m())) {
    // Others may wait in a queue, or for robots that will leave by themselves.
    if (!has_no_way(*version) && !is_near(*version, observations)) continue;
    Stay stay{version->robot, version->trajectory.rest_position_m(), now};
    const auto last = std::ranges::lower_bound(before, stay.robot, {}, &Stay::robot);
    if (last != before.end() && last->robot == stay.robot && last->since <= now &&
        (last->place_m - stay.place_m).norm() < kStays_m)
      stay = *last;
    stays_.push_back(stay);
    if (waiting_.size() == kMaxOthers) continue;
    if (now - stay.since < kStaysNearFor &&
        !observations.neighbours().is_at_rest(stay.robot, now - kWaitsAfter))
      continue;
    const OtherAssignment orders = assignment.other(stay.robot);  // costs most
    const bool waits_to_return =
        has_no_way(*version) && !is_leaving(*version) && !wants_place_of_this_robot(*version);
    if (!orders.is_held && (orders.has_drive_order || waits_to_return)) waiting_.push_back(stay.robot);
  }
  std::ranges::sort(stays_, {}, &Stay::robot);
}

double PassageYielding::view_m() const {
  return is_idle_ ? std::max(kIdleView_m, page_horizon_m(rules_)) : page_horizon_m(rules_);
}

bool PassageYielding::is_near(const Version& version, const Observations& observations) const {
  const Vec2 away = version.trajectory.at_start().position_m - observations.own().estimate().position_m;
  return away.norm() <= page_horizon_m(rules_);
}

}  // namespace sidestep
