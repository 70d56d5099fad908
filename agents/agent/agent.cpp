// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/agent.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "agents/navigation/drift.hpp"
#include "common/messaging/codec.hpp"

namespace sidestep {
namespace {

// For so long a robot may go on as fast as it may before it stops: a few cycles of what is granted ahead.
constexpr double kAhead_s = 0.15;
// By so much a page of the ledger may be older than the search that it is for.
constexpr double kPageAge_s = 0.1;
// Robots keep this much more from obstacles where they plan than where they must.
constexpr double kPlanningRoom_m = 0.03;
// A robot passes on the right only where nothing stands for so far.
constexpr double kLookAhead_m = 0.5;
// A robot that has been at rest for so long is an obstacle that others plan round; at most so many of them.
constexpr Duration kStandsAfter{1'000'000'000};
constexpr std::size_t kMostStanding = 8;
// Ways lead round the nearest few of what moves without asking, as far from it as it comes in so long.
constexpr std::size_t kMostAvoided = 4;
constexpr double kAvoidedFrom_m = 1.5;
constexpr double kAvoidedStep_m = 0.05;
constexpr Duration kAvoidedAhead{150'000'000};
// A robot that vision has not seen for so long stops: its own odometry drifts by half a per cent of its way
// and more.
constexpr Duration kLostAfter{300'000'000};
// Nearer to the goal than this a robot does not try to do better.
constexpr double kCloseEnough_m = 0.001;

/// Two robots that begin farther apart than this cannot come near to each other with what they do next.
double search_horizon_m(const FloorRules& rules) {
  const double speed = rules.limits.speed_mps;
  return 2 * speed * (kAhead_s + speed / (2 * rules.limits.deceleration_mps2)) + rules.keep_m();
}

/// Of the others who begin farther away than this, an agent need not know.
double page_horizon_m(const FloorRules& rules) {
  return search_horizon_m(rules) + 2 * rules.limits.speed_mps * kPageAge_s;
}

const RobotSpec& spec_of(const Scenario& scenario, RobotId robot) { return *find_robot(scenario, robot); }

}  // namespace

Agent::Agent(const Scenario& scenario, RobotId robot, Incarnation incarnation)
    : robot_(spec_of(scenario, robot)),
      rules_(floor_rules(scenario)),
      clocks_differ_(from_seconds(2 * scenario.clock_bound_s)),
      cycle_(scenario.cycle),
      tracking_bound_m_(scenario.tracking_bound_m),
      goal_tolerance_m_(scenario.goal_tolerance_m),
      negotiation_(robot, incarnation, scenario.cycle),
      neighbours_(robot),
      obstacles_(scenario.opponent_speed_mps, clocks_differ_),
      safety_search_(rules_, {}),
      rng_(incarnation ^ (std::uint64_t{robot} << 40)),
      estimate_{robot_.start_m, Vec2::Zero()} {
  neighbours_.look_about(robot_.start_m, page_horizon_m(rules_));
}

double Agent::planning_keep_m() const { return rules_.radius_m + rules_.margin_m + kPlanningRoom_m; }

std::vector<Circle> Agent::moving_in_the_way(Time now) {
  const Vec2& here = estimate_.position_m;
  std::vector<Circle> found;
  for (const MovingObstacle& seen : obstacles_.recent(now)) {
    if ((seen.position_m - here).norm() > kAvoidedFrom_m) continue;
    // In steps, so that ways are not found anew in every cycle.
    const Vec2 place = (seen.position_m / kAvoidedStep_m).array().round().matrix() * kAvoidedStep_m;
    const double radius = std::round(seen.radius_m / kAvoidedStep_m) * kAvoidedStep_m;
    // As much room as there is before the goal.
    const double room = (place - goal().position_m).norm() - radius - planning_keep_m() - kCloseEnough_m;
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
    return (circle.centre_m - goal().position_m).norm() < circle.radius_m + planning_keep_m();
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
  ways_.emplace(obstacles, rules_.field, rules_.radius_m, planning_keep_m() - rules_.radius_m,
                goal().position_m);
}

void Agent::on_feedback(const msg::Feedback& feedback) {
  negotiation_.on_feedback(feedback);
  const Vec2 position(feedback.x_m(), feedback.y_m()), velocity(feedback.vx_mps(), feedback.vy_mps());
  const Localisation known{feedback.deviation_m(), feedback.scale_deviation()};
  if (feedback.robot() != robot_.id || !position.allFinite() || !velocity.allFinite()) return;
  if (!(known.deviation_m >= 0) || !(known.scale_deviation >= 0)) return;
  estimate_ = {position, velocity};
  blind_way_m_ = blind_way_m(known, tracking_bound_m_);
  neighbours_.look_about(position, page_horizon_m(rules_));
  const VersionNumber stop = feedback.is_off_reference() ? feedback.executing().version_number() : 0;
  off_reference_ += stop > last_stop_;
  last_stop_ = std::max(last_stop_, stop);
  if (!negotiation_.is_fenced()) return;
  if (negotiation_.is_absent()) {
    arrived_ = false;
    return;
  }
  if (!feedback.is_lifted()) place_m_.reset();  // it has been put down
  const Trajectory& executing = negotiation_.executing().trajectory;
  const bool at_rest = time_from_ns(feedback.at_ns()) >= executing.end();
  arrived_ = at_rest && (executing.rest_position_m() - goal().position_m).norm() < goal_tolerance_m_;
  if (arrived_ && goal_index_ + 1 < robot_.goals.size()) {
    ++goal_index_;
    arrived_ = false;
    ways_.reset();
  }
}

void Agent::on_world(const msg::WorldState& world, Time now) {
  obstacles_.on_world(world, now);
  const auto& robots = world.robots();
  // Usually where it was in the last message.
  if (in_world_ >= robots.size() || robots[in_world_].robot() != robot_.id) {
    const auto found = std::ranges::find_if(robots, [&](const auto& r) { return r.robot() == robot_.id; });
    in_world_ = static_cast<std::size_t>(found - robots.begin());
    if (found == robots.end()) return;
  }
  const msg::TrackedRobot& seen = robots[in_world_];
  if (seen.seen_at_ns() <= last_fix_ns_) return;
  const bool is_sound = std::isfinite(seen.seen_x_m()) && std::isfinite(seen.seen_y_m()) &&
                        std::isfinite(seen.seen_heading_rad()) &&
                        seen.seen_at_ns() <= to_ns(now + clocks_differ_);
  if (!is_sound) {
    ++invalid_;
    return;
  }
  last_fix_ns_ = seen.seen_at_ns();
  fix_.emplace();
  fix_->captured_at_ns(seen.seen_at_ns());
  fix_->x_m(seen.seen_x_m());
  fix_->y_m(seen.seen_y_m());
  fix_->heading_rad(seen.seen_heading_rad());
}

void Agent::on_ledger(const msg::LedgerPage& page, std::shared_ptr<void>* beside) {
  neighbours_.on_page(page, beside);
}

void Agent::on_disturbance(const msg::Disturbance& disturbance) {
  if (disturbance.robot() != robot_.id || disturbance.disturbance_kind() != msg::DISTURBANCE_PLACE) return;
  const Vec2 place(disturbance.x_m(), disturbance.y_m());
  if (place.allFinite()) {
    place_m_ = place;
  } else {
    ++invalid_;
  }
}

bool Agent::wants_stand(Time now) const {
  return place_m_ && negotiation_.is_absent() && negotiation_.may_propose(now);
}

msg::Proposal Agent::propose_stand(Time now, Time start) {
  const Trajectory stand = Trajectory::resting(start, *place_m_);
  return negotiation_.propose({&stand, 1}, 0, now);
}

void Agent::on_coordinator_state(const msg::CoordinatorState& state, Time now) {
  negotiation_.on_coordinator_state(state, now);
}

std::optional<SearchQuery> Agent::plan(Time now, Time start) {
  const Duration unseen = now - time_from_ns(last_fix_ns_);
  // Farther in the future than it can be unknown what the robot's clock shows, somebody has set a clock.
  const bool is_lost = unseen > kLostAfter || unseen < -kLostAfter;
  if (!negotiation_.may_propose(now) || negotiation_.is_absent() || is_lost) return std::nullopt;
  const Version& base = negotiation_.base_at(start);
  const Vec2 rest = base.trajectory.rest_position_m();
  const double grown_m = growth_from(base, start);
  const bool is_there = (rest - goal().position_m).norm() < kCloseEnough_m && grown_m == base.grown_m;
  if (is_there || start <= base.trajectory.start()) return std::nullopt;
  base_ = base.number;
  const State there = base.trajectory.state_at(start);
  update_ways(now);
  const Vec2 to_goal = goal().position_m - there.position_m;
  const Route route = ways_->route_from(there.position_m).value_or(Route{goal().position_m, to_goal.norm()});
  const Vec2 direction = direction_beside(there.position_m, route);
  // It comes to rest before it would drift too far were it never seen again.
  const double blind_m = std::max(0.0, blind_way_m_ - (there.position_m - estimate_.position_m).norm());
  const MotionWish wish = wished_motion(std::min(route.length_m, blind_m) * direction, there.velocity_mps,
                                        rules_.limits, cycle_, cycle_ * negotiation_.lead());
  return SearchQuery{start, there, wish.acceleration_mps2, wish.hold, grown_m, obstacles_.recent(now)};
}

double Agent::growth_from(const Version& base, Time start) const {
  const bool is_at_rest = start >= base.trajectory.end();
  const bool was_seen_there = last_fix_ns_ > to_ns(base.trajectory.end());
  return is_at_rest && was_seen_there ? 0 : base.grown_m;
}

Vec2 Agent::direction_beside(const Vec2& here, const Route& route) const {
  const Vec2 straight = (route.waypoint_m - here).stableNormalized();
  const double look_ahead = std::min(route.length_m, kLookAhead_m);
  for (const double share : {1.0, 0.75, 0.5, 0.25}) {
    const Vec2 direction = rotated(straight, -share * passing_.angle_rad(route.length_m));
    const Vec2 ahead = here + look_ahead * direction;
    if (rules_.field.contains(ahead, rules_.radius_m) && ways_->sees(here, ahead)) return direction;
  }
  return straight;
}

std::optional<msg::Proposal> Agent::search(const SearchQuery& query, Time now) {
  Crowd& others = neighbours_.crowd(query.at_start.position_m, search_horizon_m(rules_));
  SearchResult result = safety_search_.search(query, others, rng_);
  if (result.count == 0) result = search_escape(query, negotiation_.base_at(query.start), others, rules_);
  passing_.update(result.wish_is_clear, query.at_start.velocity_mps.norm(), now);
  if (result.count == 0) return std::nullopt;
  return negotiation_.propose({result.candidates.data(), result.count}, base_, now, query.grown_m);
}

std::optional<msg::Command> Agent::on_verdict(const msg::Verdict& verdict, Time now) {
  const auto granted = negotiation_.on_verdict(verdict, now);
  if (!granted) return std::nullopt;
  forwarded_ = granted;
  return command(now);
}

msg::Command Agent::command(Time now) {
  if (forwarded_ && forwarded_->trajectory.start() <= now) forwarded_.reset();
  msg::Command command;
  command.robot(robot_.id);
  command.epoch(negotiation_.epoch());
  command.has_version(forwarded_.has_value());
  if (forwarded_) command.granted(encode(*forwarded_));
  command.has_fix(fix_.has_value());
  if (fix_) command.fix(*fix_);
  fix_.reset();
  command.heading_rad(goal().heading_rad.value_or(robot_.start_heading_rad));
  return command;
}

msg::AgentStatus Agent::status(Time now) const {
  msg::AgentStatus status;
  status.robot(robot_.id);
  const Negotiation& n = negotiation_;
  status.agent_phase(!n.is_fenced()           ? msg::AGENT_FENCING
                     : n.needs_registration() ? msg::AGENT_REGISTERING
                     : n.is_absent()          ? msg::AGENT_ABSENT
                     : arrived_               ? msg::AGENT_ARRIVED
                     : n.may_propose(now)     ? msg::AGENT_DRIVING
                                              : msg::AGENT_WAITING);
  status.goal_index(static_cast<std::uint32_t>(goal_index_));
  status.distance_to_go_m((goal().position_m - estimate_.position_m).norm());
  status.speed_mps(estimate_.velocity_mps.norm());
  status.cycles(n.counts().cycles);
  status.missed_cycles(n.counts().missed);
  status.off_reference(off_reference_);
  status.lost_versions(n.counts().lost);
  status.proposals(n.counts().proposals);
  status.grants(n.counts().grants);
  status.denials(n.counts().denials);
  status.invalid(n.counts().invalid + neighbours_.invalid() + obstacles_.invalid() + invalid_);
  return status;
}

}  // namespace sidestep
