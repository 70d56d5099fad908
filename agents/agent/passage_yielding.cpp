// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/passage_yielding.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
#include <tuple>
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
constexpr Duration kTremblesFor{2'000'000'000};
constexpr double kStays_m = 0.1;  ///< distance from that place
/// Interval between two looks of an idle robot for robots that wait.
constexpr Duration kLookPeriod{250'000'000};
/// Idle robots notice robots that wait for them at this distance. They may wait where the way is wider.
constexpr double kIdleView_m = 20;
/// Number of robots that idle robots consider: first those that wait, then the nearest.
constexpr std::size_t kMaxOthers = 32;
/// A robot without an order that heads for a place this far away, which is not its own, makes room for
/// others.
constexpr double kLeaves_m = 0.1;
/// Longer trips of other robots are considered only up to the next waypoint.
constexpr double kLongestTrip_m = 20;

}  // namespace

PassageYielding::PassageYielding(const FloorRules& rules)
    : rules_(rules),
      passage_period_(from_seconds(kPassageExtra_s + kPassageDistance_m / rules.limits.speed_mps)),
      give_way_({rules.field, rules.radius_m, required_separation_m(rules), rules.min_separation_m()},
                {.give_up_after = passage_period_ * 2 / 3}) {}

void PassageYielding::update(Time now, const Vec2& home_m, Observations& observations,
                             const Assignment& assignment, RouteToTarget& route, Rng& rng) {
  const bool is_idle = !assignment.goal() || assignment.report().progress.is_finished();
  if (std::exchange(is_idle_, is_idle) != is_idle) give_way_.restart(now);
  observations.set_view(view_m());
  if (is_idle && std::chrono::abs(now - looked_at_) >= kLookPeriod) {
    looked_at_ = now;
    find_waiting(now, observations, assignment);
  }
  home_m_ = home_m;
  const bool is_paused = now < paused_until_ && paused_until_ - now <= pause_;
  if (is_idle && !give_way_.place_m() && (waiting_.empty() || is_paused)) return give_way_.restart(now);
  const double remaining_m =
      !is_idle && route.has_route() ? remaining_to_goal_m_ : std::numeric_limits<double>::infinity();
  if (!give_way_.track_progress(now, remaining_m)) return;
  if (give_way_.is_searching()) {
    give_way_.search(now, rng);
    if (!is_idle || !give_way_.has_given_up()) return;
    pause_ = std::min(std::max(2 * pause_, kFirstPause), kLongestPause);
    paused_until_ = now + pause_;
    return;
  }
  give_way_.begin_search(now, observations.own().estimate().position_m,
                         others_in_passages(now, observations, assignment), route.obstacles().fixed_world(),
                         is_idle ? std::optional(home_m) : std::nullopt);
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
    other.rests = other.waits || observations.neighbours().is_at_rest(version->robot, now - kWaitsAfter);
    if (!is_near(*version, observations) && !other.waits) other.has_right_of_way = other.returns = false;
  }
  if (is_idle_ && others.size() > kMaxOthers) {
    std::ranges::sort(others, {}, [&](const OtherRobot& other) {
      return std::tuple(!other.waits, (other.position_m - position_m).squaredNorm(), other.id);
    });
    others.resize(kMaxOthers);
  }
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
    const bool leaves = is_leaving(version);
    if (leaves || !is_idle_) other.goals_m[1].reset();
    if (leaves) other.end_m.reset();  // it goes out of the way again later
    const bool waits_to_return = is_idle_ && has_no_way(version) && !wants_place_of_this_robot(version);
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
  return version.intent && version.intent->goal_m != version.intent->target_m;
}

bool PassageYielding::is_leaving(const Version& version) {
  return has_no_way(version) &&
         (version.intent->goal_m - version.trajectory.rest_position_m()).norm() >= kLeaves_m;
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
    const auto last = std::ranges::find(before, stay.robot, &Stay::robot);
    if (last != before.end() && last->since <= now && (last->place_m - stay.place_m).norm() < kStays_m)
      stay = *last;
    stays_.push_back(stay);
    if (now - stay.since < kTremblesFor &&
        !observations.neighbours().is_at_rest(stay.robot, now - kWaitsAfter))
      continue;
    const OtherAssignment orders = assignment.other(stay.robot);  // costs most
    if (!orders.is_held && (orders.has_drive_order || (has_no_way(*version) && !is_leaving(*version))))
      waiting_.push_back(stay.robot);
  }
}

double PassageYielding::view_m() const {
  return is_idle_ ? std::max(kIdleView_m, page_horizon_m(rules_)) : page_horizon_m(rules_);
}

bool PassageYielding::is_near(const Version& version, const Observations& observations) const {
  const Vec2 away = version.trajectory.at_start().position_m - observations.own().estimate().position_m;
  return away.norm() <= page_horizon_m(rules_);
}

}  // namespace sidestep
