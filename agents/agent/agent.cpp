// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/agent.hpp"

#include <algorithm>
#include <utility>

#include "agents/navigation/dead_reckoning.hpp"
#include "agents/navigation/trapezoidal_profile.hpp"
#include "common/time/clock_bounds.hpp"

namespace sidestep {
namespace {

const RobotSpec& spec_of(const Scenario& scenario, RobotId robot) { return *find_robot(scenario, robot); }

}  // namespace

Agent::Agent(const Scenario& scenario, RobotId robot, Incarnation incarnation,
             std::shared_ptr<PlanningScratch> scratch, const PlanningSettings& settings)
    : robot_(spec_of(scenario, robot)),
      settings_(settings),
      scratch_(std::move(scratch)),
      rules_(scratch_->rules),
      max_clock_difference_(max_clock_difference(scenario.clock_bound_s)),
      cycle_(scenario.cycle),
      drift_bound_m_(drift_bound_m(scenario.tracking_bound_m)),
      goal_tolerance_m_(scenario.goal_tolerance_m),
      negotiation_(robot, incarnation, scenario.cycle),
      neighbours_(robot),
      obstacles_(scenario.max_opponent_speed_mps, max_clock_difference_),
      displaced_(robot, scenario.radius_m, scenario.margin_m,
                 std::max(scenario.max_opponent_speed_mps, scenario.limits.speed_mps), max_clock_difference_),
      max_person_speed_mps_(scenario.max_opponent_speed_mps),
      scan_period_(scenario.laser ? from_seconds(1 / scenario.laser->rate_hz) : Duration{0}),
      rng_(incarnation ^ (std::uint64_t{robot} << 40)),
      assignment_(robot, robot_.goals, roster_of(scenario)),
      desired_heading_rad_(robot_.start_heading_rad),
      planner_(make_driving_planner(robot_.planner.empty() ? scenario.planner : robot_.planner)),
      passage_period_(from_seconds(settings.passage_s + settings.passage_m / rules_.limits.speed_mps)),
      give_way_({rules_.field, rules_.radius_m, required_separation_m(), rules_.min_separation_m()},
                {.give_up_after = passage_period_ * 2 / 3}),
      estimate_{robot_.start_m, Vec2::Zero()} {
  neighbours_.set_horizon(robot_.start_m, page_horizon_m());
  if (!scenario.laser) return;
  sight_.emplace(*scenario.laser, rules_,
                 LaserSightSettings{.position_error_m = scenario.tracking_bound_m,
                                    .heading_error_rad = settings_.max_heading_error_rad});
}

bool Agent::on_feedback(const Feedback& feedback) {
  negotiation_.on_feedback(feedback);
  update_estimate(feedback);
  if (negotiation_.is_fenced()) update_goal(feedback);
  return negotiation_.is_contradicted();
}

void Agent::update_estimate(const Feedback& feedback) {
  estimate_ = feedback.estimate;
  max_dead_reckoning_m_ = max_dead_reckoning_m(feedback.uncertainty, drift_bound_m_);
  neighbours_.set_horizon(estimate_.position_m, page_horizon_m());
  const VersionNumber stop = feedback.is_off_reference ? feedback.executing.number : 0;
  reference_losses_ += stop > last_own_stop_;
  robot_has_moved_ |= feedback.has_moved;
  last_own_stop_ = std::max(last_own_stop_, stop);
}

void Agent::update_goal(const Feedback& feedback) {
  if (negotiation_.is_absent()) {
    arrived_ = false;
    return;
  }
  if (!feedback.is_lifted) placement_m_.reset();  // the robot has been put down
  if (!assignment_.goal()) return;
  const Trajectory& executing = negotiation_.executing().trajectory;
  const bool is_at_rest = feedback.valid_at >= executing.end();
  arrived_ = is_at_rest && (executing.rest_position_m() - goal().position_m).norm() <
                               goal().tolerance_m.value_or(goal_tolerance_m_);
  if (!arrived_) return;
  const std::uint64_t revision = assignment_.revision();
  assignment_.on_arrival();
  begin_if_changed(revision);
}

void Agent::on_orders(std::shared_ptr<const OrderPage> page) {
  const std::uint64_t revision = assignment_.revision(), zone_revision = assignment_.zone_revision();
  assignment_.on_page(std::move(page));
  begin_if_changed(revision);
  if (assignment_.zone_revision() == zone_revision) return;
  zones_ = ZoneMap(assignment_.zones());
  give_way_.restart(last_plan_);
  route_obstacles_.reset();
  route_planner_.reset();
  has_route_ = false;
}

void Agent::choose_order() {
  const std::uint64_t revision = assignment_.revision();
  assignment_.choose();
  begin_if_changed(revision);
}

void Agent::begin_if_changed(std::uint64_t revision) {
  if (assignment_.revision() == revision) return;
  arrived_ = false;
  has_route_ = false;
  blockage_.reset();
  blocked_since_.reset();
  give_way_.restart(last_plan_);
  if (assignment_.goal()) desired_heading_rad_ = goal().heading_rad.value_or(robot_.start_heading_rad);
}

bool Agent::is_unserved(Time now) const {
  if (negotiation_.is_unserved(now)) return true;
  // Vision works, but the coordinator does not receive it.
  const auto is_recent = [&](Time t, Duration max_age) { return std::chrono::abs(now - t) <= max_age; };
  return negotiation_.wait_reason(now) == WaitReason::kNone && !negotiation_.is_absent() &&
         is_recent(last_fix_, settings_.max_fix_age) && !is_recent(watched_until_, settings_.max_watch_age);
}

bool Agent::is_told_all_orders() const {
  if (assignment_.remembers_nothing()) return true;
  return in_charge_.epoch == negotiation_.epoch() &&
         assignment_.is_told_by(in_charge_.coordinator, in_charge_.incarnation);
}

Registration Agent::registration() {
  Registration registration = negotiation_.registration();
  const Epoch former = negotiation_.former_epoch();
  registration.has_moved = robot_has_moved_ || (former != 0 && former != registration.epoch);
  registration.knows_orders = assignment_.is_known();
  return registration;
}

void Agent::on_world(const WorldObservations& world, Time now, bool is_robot_clock_known) {
  // The robot's clock was ahead when the last fix was accepted.
  if (is_robot_clock_known && last_fix_ > now + max_clock_difference_) last_fix_ = {};
  if (!world.self) return;
  const Time captured_at = world.self->captured_at;
  const bool is_ahead =
      is_robot_clock_known ? captured_at > now + max_clock_difference_ : !is_plausible(captured_at, now);
  if (is_ahead) {
    ++invalid_;
    return;
  }
  obstacles_.on_world(world);
  if (captured_at <= last_fix_) return;
  fix_ = world.self;
  if (!is_robot_clock_known) return;
  last_fix_ = captured_at;
  last_fix_m_ = fix_->position_m;
}

void Agent::on_coordinator_state(const CoordinatorHeartbeat& heartbeat, Time now) {
  negotiation_.on_coordinator_state(heartbeat, now);
  if (heartbeat.epoch != negotiation_.epoch() || heartbeat.epoch == 0) return;
  in_charge_ = {heartbeat.sender, heartbeat.incarnation, heartbeat.epoch};
  displaced_.on_heartbeat(heartbeat, now);
  watched_until_ = heartbeat.watched_until;
}

Agent::VerdictResult Agent::on_verdict(const Verdict& verdict, Time now) {
  const Negotiation::VerdictResult result = negotiation_.on_verdict(verdict, now);
  if (!result.granted) return {std::nullopt, result.round_trip};
  forwarded_ = result.granted;
  return {command(now), result.round_trip};
}

std::optional<Time> Agent::start_to_propose(Time now, Time next_cycle) const {
  if (!negotiation_.is_fenced()) return std::nullopt;
  if (!negotiation_.has_upcoming_version(now)) return earliest_start(next_cycle);
  return negotiation_.retry_start(now);
}

bool Agent::needs_rest_version(Time now) const {
  return placement_m_ && negotiation_.is_absent() && negotiation_.may_propose(now);
}

Proposal Agent::propose_rest_version(Time now, Time start) {
  const Trajectory rest = Trajectory::resting(start, *placement_m_);
  return negotiation_.propose({&rest, 1}, 0, now);
}

Command Agent::command(Time now) {
  if (forwarded_ && forwarded_->trajectory.start() <= now) forwarded_.reset();
  Command command{robot_.id, negotiation_.incarnation(), negotiation_.command_epoch()};
  command.version = forwarded_;
  command.fix = std::exchange(fix_, std::nullopt);
  command.desired_heading_rad = desired_heading_rad_;
  return command;
}

AgentActivity Agent::activity(Time now) const {
  return {negotiation_.is_fenced(),   negotiation_.is_superseded(),
          negotiation_.incarnation(), negotiation_.is_registered(),
          negotiation_.epoch(),       wait_reason(now),
          assignment_.goal_index(),   arrived_,
          recovery_.is_active(),      is_escaping_};
}

msg::AgentStatus Agent::status(Time now) const {
  msg::AgentStatus status;
  status.robot(robot_.id);
  const Negotiation& n = negotiation_;
  status.agent_state(!n.is_fenced()            ? msg::AgentState::AGENT_FENCING
                     : n.needs_registration()  ? msg::AgentState::AGENT_REGISTERING
                     : n.is_absent()           ? msg::AgentState::AGENT_ABSENT
                     : assignment_.is_held()   ? msg::AgentState::AGENT_HELD
                     : !assignment_.is_known() ? msg::AgentState::AGENT_WAITING
                     : arrived_                ? msg::AgentState::AGENT_ARRIVED
                     : !assignment_.goal()     ? msg::AgentState::AGENT_WITHOUT_ORDER
                     : n.may_propose(now)      ? msg::AgentState::AGENT_DRIVING
                                               : msg::AgentState::AGENT_WAITING);
  status.goal_index(static_cast<std::uint32_t>(assignment_.goal_index()));
  if (assignment_.goal()) status.distance_to_go_m((goal().position_m - estimate_.position_m).norm());
  status.speed_mps(estimate_.velocity_mps.norm());
  status.cycles(n.counts().cycles);
  status.missed_cycles(n.counts().missed);
  status.reference_losses(reference_losses_);
  status.route_changes(last_choice_.changes);
  status.lost_versions(n.counts().lost);
  status.proposals(n.counts().proposals);
  status.grants(n.counts().grants);
  status.denials(n.counts().denials);
  return status;
}

OrderReport Agent::order_report() const {
  OrderReport report = assignment_.report();
  const bool is_blocked = blocked_since_ && last_plan_ - *blocked_since_ >= settings_.blocked_after;
  if (assignment_.goal() && is_blocked) report.blockage = blockage_;
  return report;
}

std::optional<double> Agent::remaining_s() const {
  if (!assignment_.goal() || blocked_since_ || give_way_.place_m() || (!has_route_ && !arrived_))
    return std::nullopt;
  if (assignment_.report().progress.is_finished()) return 0;
  double length_m = route_length_m_, seconds = 0;
  Vec2 from = goal().position_m;
  for (const Goal& goal : assignment_.goals_left()) {
    MotionLimits limits = rules_.limits;
    limits.speed_mps = std::min(limits.speed_mps, goal.speed_limit_mps.value_or(limits.speed_mps));
    if (&goal != assignment_.goal()) length_m = (goal.position_m - from).norm();
    seconds += TrapezoidalProfile::duration_s(length_m, 0, limits);
    from = goal.position_m;
  }
  return seconds;
}

void Agent::count_drops(DropCounters& drops) const {
  const Negotiation::Counts& counts = negotiation_.counts();
  drops.count(DropReason::kUnproposedGrant, std::nullopt, counts.unproposed_grants);
  drops.count(DropReason::kUnexpectedVerdict, std::nullopt, counts.unexpected_verdicts);
  drops.count(DropReason::kLateFact, std::nullopt, counts.late_facts);
  drops.count(DropReason::kOldEpoch, std::nullopt, counts.old_epochs);
  drops.count(DropReason::kFutureObservation, std::nullopt, invalid_);
  drops.count(DropReason::kFutureObstacles, std::nullopt, obstacles_.invalid() + future_scans_);
  neighbours_.count_drops(drops);
}

}  // namespace sidestep
