// SPDX-License-Identifier: Apache-2.0
// Where an agent would like its robot to go next.
#include <algorithm>
#include <cmath>
#include <utility>

#include "agents/agent/agent.hpp"

namespace sidestep {
namespace {

// For so long a robot may go on as fast as it may before it stops: a few cycles of what is granted ahead.
constexpr double kAhead_s = 0.15;
// By so much a page of the ledger may be older than the search that it is for.
constexpr double kPageAge_s = 0.1;
// Robots keep this much more from obstacles where they plan than where they must.
constexpr double kPlanningRoom_m = 0.03;
// Evading leads only where nothing stands for so far, and is held for so long.
constexpr double kLookAhead_m = 0.5;
constexpr double kEvading_s = 0.3;
// A robot that has been at rest for so long is an obstacle that others plan round; at most so many of them.
constexpr Duration kStandsAfter{500'000'000};
constexpr std::size_t kMostStanding = 8;
// Ways lead round the nearest few of what moves without asking, as far from it as it comes in so long.
constexpr std::size_t kMostAvoided = 4;
constexpr double kAvoidedFrom_m = 1.5;
constexpr double kAvoidedStep_m = 0.05;
constexpr Duration kAvoidedAhead{150'000'000};
// A robot that vision has not seen for so long stops: its own odometry drifts by half a per cent of its way
// and more.
constexpr Duration kLostAfter{300'000'000};
// Nearer to the goal than this a robot does not try to do better, and others take it for being there.
constexpr double kCloseEnough_m = 0.001;
constexpr double kThere_m = 0.02;
// Slower than this a velocity is rest, and slower than a share of what it may a robot waits.
constexpr double kRest_mps = 0.01;
constexpr double kWaiting = 0.5;
// Robots with lower and with higher numbers have the right of way in turns, for so long each.
constexpr Duration kRightOfWay{10'000'000'000};

/// Where a version's robot will be, and how fast it would still be if it did not stop as the version must.
State state_going_on(const Trajectory& trajectory, Time t) {
  State state = trajectory.state_at(t);
  if (trajectory.phases().empty() || t >= trajectory.end()) return state;
  const Time held = trajectory.start() + trajectory.phases().front().duration;
  if (t > held) state.velocity_mps = trajectory.state_at(held).velocity_mps;
  return state;
}

/// Who makes way for whom has to be the same for all, or choices chase each other; and nobody shall always be
/// the one who does.
bool has_right_of_way(RobotId other, RobotId self, Time t) {
  const bool low_first = t.time_since_epoch() / kRightOfWay % 2 == 0;
  return (other < self) == low_first;
}

/// What is left at a time of what a version's robot means to do; nullopt when it will stay where it is.
std::optional<Intent> intent_at(const Version& version, Time t) {
  if (!version.intent) return std::nullopt;
  const bool rests = t >= version.trajectory.end();
  if (rests && (version.trajectory.rest_position_m() - version.intent->goal_m).norm() < kThere_m)
    return std::nullopt;
  Intent intent = *version.intent;
  intent.hold_s = std::max(0.0, intent.hold_s - to_seconds(t - version.trajectory.start()));
  return intent;
}

}  // namespace

double Agent::search_horizon_m() const {
  const double speed = rules_.limits.speed_mps;
  return 2 * speed * (kAhead_s + speed / (2 * rules_.limits.deceleration_mps2)) + rules_.min_separation_m();
}

double Agent::page_horizon_m() const { return search_horizon_m() + 2 * rules_.limits.speed_mps * kPageAge_s; }

double Agent::planning_separation_m() const { return rules_.radius_m + rules_.margin_m + kPlanningRoom_m; }

std::vector<Circle> Agent::moving_in_the_way(Time now) {
  const Vec2& here = estimate_.position_m;
  std::vector<Circle> found;
  for (const MovingObstacle& seen : obstacles_.recent(now)) {
    if ((seen.position_m - here).norm() > kAvoidedFrom_m) continue;
    // In steps, so that ways are not found anew in every cycle.
    const Vec2 place = (seen.position_m / kAvoidedStep_m).array().round().matrix() * kAvoidedStep_m;
    const double radius = std::round(seen.radius_m / kAvoidedStep_m) * kAvoidedStep_m;
    // As much room as there is before the goal.
    const double room = (place - goal().position_m).norm() - radius - planning_separation_m() - kCloseEnough_m;
    const double wanted = kAvoidedStep_m + seen.speed_mps * to_seconds(kAvoidedAhead);
    found.push_back({place, radius + std::clamp(room, 0.0, wanted)});
  }
  std::ranges::sort(found, {}, [&](const Circle& c) { return (c.centre_m - here).squaredNorm(); });
  if (found.size() > kMostAvoided) found.resize(kMostAvoided);
  std::ranges::sort(found, {}, [](const Circle& c) { return std::pair(c.centre_m.x(), c.centre_m.y()); });
  return found;
}

std::vector<Circle> Agent::in_the_way(Time now) {
  std::vector<Circle> found = moving_in_the_way(now);
  for (const Vec2& place : neighbours_.standing(now - kStandsAfter, estimate_.position_m, kMostStanding)) {
    found.push_back({place, rules_.radius_m});
  }
  // Whoever is on the goal is no obstacle on the way to it.
  std::erase_if(found, [&](const Circle& circle) {
    return (circle.centre_m - goal().position_m).norm() < circle.radius_m + planning_separation_m();
  });
  return found;
}

void Agent::update_ways(Time now) {
  std::vector<Circle> found = in_the_way(now);
  const auto is_same = [](const Circle& a, const Circle& b) {
    return a.centre_m == b.centre_m && a.radius_m == b.radius_m;
  };
  if (ways_ && std::ranges::equal(found, in_the_way_, is_same)) return;
  in_the_way_ = std::move(found);
  std::vector<Circle> obstacles = rules_.obstacles;
  obstacles.insert(obstacles.end(), in_the_way_.begin(), in_the_way_.end());
  ways_.emplace(obstacles, rules_.field, rules_.radius_m, rules_.margin_m, kPlanningRoom_m,
                goal().position_m);
}

std::optional<SearchQuery> Agent::plan(Time now, Time start) {
  const Duration unseen = now - time_from_ns(last_fix_ns_);
  // Farther in the future than it can be unknown what the robot's clock shows, somebody has set a clock.
  const bool is_lost = unseen > kLostAfter || unseen < -kLostAfter;
  if (!negotiation_.may_propose(now) || negotiation_.is_absent() || is_lost) return std::nullopt;
  const Version& base = negotiation_.base_at(start);
  const Vec2 rest = base.trajectory.rest_position_m();
  const double inflation_m = inflation_from(base, start);
  const bool is_there = (rest - goal().position_m).norm() < kCloseEnough_m && inflation_m == base.inflation_m;
  if (is_there || start <= base.trajectory.start()) return std::nullopt;
  base_ = base.number;
  const State there = base.trajectory.state_at(start);
  update_ways(now);
  const Route straight{goal().position_m, (goal().position_m - there.position_m).norm()};
  const Route route = ways_->route_from(there.position_m).value_or(straight);
  intent_ = steer(there, start, route);
  const AccelerationCommand desired = desired_for(intent_, there, route);
  return SearchQuery{start, there, desired.acceleration_mps2, desired.hold, inflation_m, obstacles_.recent(now)};
}

Intent Agent::steer(const State& there, Time start, const Route& route) {
  if (recovery_.is_needed()) {
    return {rules_.limits.speed_mps * direction_beside(there.position_m, route), kEvading_s, route.waypoint_m,
            goal().position_m};
  }
  Steering& steering = bench_->steering;
  steering.clear();
  for (const Version* version : neighbours_.newest(there.position_m, page_horizon_m())) {
    const State state = state_going_on(version->trajectory, start);
    const double keep = rules_.min_separation_m() + version->inflation_m;
    const std::optional<Intent> intent = intent_at(*version, start);
    if (!intent)
      steering.add_standing(state.position_m, keep);
    else if (has_right_of_way(version->robot, robot_.id, start))
      steering.add_moving(state, *intent, keep);
  }
  for (const Circle& obstacle : rules_.obstacles)
    steering.add_standing(obstacle.centre_m, obstacle.radius_m + rules_.radius_m + rules_.margin_m);
  const double since = std::max(0.0, to_seconds(start - steered_for_));
  steered_for_ = start;
  return steering.choose(there, route.waypoint_m, goal().position_m, since, last_choice_);
}

AccelerationCommand Agent::desired_for(const Intent& intent, const State& there, const Route& route) const {
  // It comes to rest before it would drift too far were it never seen again.
  const double blind_m = std::max(0.0, blind_path_m_ - (there.position_m - estimate_.position_m).norm());
  const double length = std::min(route.length_m, blind_m);
  MotionLimits limits = rules_.limits;
  Vec2 to_go = length * (intent.waypoint_m - there.position_m).stableNormalized();
  if (intent.hold_s > 0) {
    const double speed = intent.velocity_mps.norm();
    to_go = speed < kRest_mps ? Vec2::Zero() : Vec2(length / speed * intent.velocity_mps);
    if (speed >= kRest_mps) limits.speed_mps = speed;
  }
  return desired_acceleration(to_go, there.velocity_mps, limits, cycle_, cycle_ * negotiation_.lead());
}

double Agent::inflation_from(const Version& base, Time start) const {
  const bool is_at_rest = start >= base.trajectory.end();
  const bool was_seen_there = last_fix_ns_ > to_ns(base.trajectory.end());
  return is_at_rest && was_seen_there ? 0 : base.inflation_m;
}

Vec2 Agent::direction_beside(const Vec2& here, const Route& route) const {
  const Vec2 straight = (route.waypoint_m - here).stableNormalized();
  const double look_ahead = std::min(route.length_m, kLookAhead_m);
  for (const double share : {1.0, 0.75, 0.5, 0.25}) {
    const Vec2 direction = rotated(straight, -share * recovery_.angle_rad());
    const Vec2 ahead = here + look_ahead * direction;
    if (rules_.field.contains(ahead, rules_.radius_m) && ways_->sees(here, ahead)) return direction;
  }
  return straight;
}

std::optional<msg::Proposal> Agent::search(const SearchQuery& query, Time now) {
  TrajectoryIndex& others = bench_->crowd;
  neighbours_.gather(query.at_start.position_m, search_horizon_m(), others);
  SearchResult result = bench_->safety_search.search(query, others, rng_);
  if (result.count == 0) result = search_escape(query, negotiation_.base_at(query.start), others, rules_);
  const bool waits = intent_.hold_s > 0 && intent_.velocity_mps.norm() < kWaiting * rules_.limits.speed_mps;
  recovery_.update(result.desired_is_clear && !waits, query.at_start.velocity_mps.norm(), now);
  if (result.count == 0) return std::nullopt;
  return negotiation_.propose({result.candidates.data(), result.count}, base_, now, query.inflation_m, intent_);
}

}  // namespace sidestep
