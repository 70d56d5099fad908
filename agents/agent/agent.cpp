// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/agent.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "agents/navigation/dead_reckoning.hpp"
#include "common/messaging/codec.hpp"

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
      max_clock_difference_(from_seconds(2 * scenario.clock_bound_s)),
      cycle_(scenario.cycle),
      tracking_bound_m_(scenario.tracking_bound_m),
      goal_tolerance_m_(scenario.goal_tolerance_m),
      negotiation_(robot, incarnation, scenario.cycle),
      neighbours_(robot),
      obstacles_(scenario.max_opponent_speed_mps, max_clock_difference_),
      rng_(incarnation ^ (std::uint64_t{robot} << 40)),
      estimate_{robot_.start_m, Vec2::Zero()} {
  neighbours_.set_horizon(robot_.start_m, page_horizon_m());
}

bool Agent::on_feedback(const msg::Feedback& feedback) {
  negotiation_.on_feedback(feedback);
  if (update_estimate(feedback) && negotiation_.is_fenced()) update_goal(feedback);
  return negotiation_.is_contradicted();
}

bool Agent::update_estimate(const msg::Feedback& feedback) {
  const Vec2 position(feedback.x_m(), feedback.y_m()), velocity(feedback.vx_mps(), feedback.vy_mps());
  const LocalisationUncertainty uncertainty{feedback.position_error_rms_m(),
                                            feedback.odometry_scale_stddev()};
  if (feedback.robot() != robot_.id || !position.allFinite() || !velocity.allFinite()) return false;
  // The comparisons are false for NaN.
  if (!(uncertainty.position_error_rms_m >= 0) || !(uncertainty.odometry_scale_stddev >= 0)) return false;
  estimate_ = {position, velocity};
  max_dead_reckoning_m_ = max_dead_reckoning_m(uncertainty, tracking_bound_m_);
  neighbours_.set_horizon(position, page_horizon_m());
  const VersionNumber stop = feedback.is_off_reference() ? feedback.executing().version_number() : 0;
  reference_losses_ += stop > last_own_stop_;
  last_own_stop_ = std::max(last_own_stop_, stop);
  return true;
}

void Agent::update_goal(const msg::Feedback& feedback) {
  if (negotiation_.is_absent()) {
    arrived_ = false;
    return;
  }
  if (!feedback.is_lifted()) placement_m_.reset();  // the robot has been put down
  const Trajectory& executing = negotiation_.executing().trajectory;
  const bool is_at_rest = time_from_ns(feedback.valid_at_ns()) >= executing.end();
  arrived_ = is_at_rest && (executing.rest_position_m() - goal().position_m).norm() < goal_tolerance_m_;
  if (arrived_ && goal_index_ + 1 < robot_.goals.size()) {
    ++goal_index_;
    arrived_ = false;
    route_planner_.reset();
  }
}

void Agent::on_world(const msg::WorldState& world, Time now) {
  obstacles_.on_world(world, now);
  const auto& robots = world.robots();
  // The index rarely changes between messages.
  if (world_index_ >= robots.size() || robots[world_index_].robot() != robot_.id) {
    const auto found = std::ranges::find_if(robots, [&](const auto& r) { return r.robot() == robot_.id; });
    world_index_ = static_cast<std::size_t>(found - robots.begin());
    if (found == robots.end()) return;
  }
  const msg::TrackedRobot& observed = robots[world_index_];
  if (observed.observed_at_ns() <= last_fix_ns_) return;
  const bool is_valid = std::isfinite(observed.observed_x_m()) && std::isfinite(observed.observed_y_m()) &&
                        std::isfinite(observed.observed_heading_rad()) &&
                        observed.observed_at_ns() <= to_ns(now + max_clock_difference_);
  if (!is_valid) {
    ++invalid_;
    return;
  }
  last_fix_ns_ = observed.observed_at_ns();
  fix_.emplace();
  fix_->captured_at_ns(observed.observed_at_ns());
  fix_->x_m(observed.observed_x_m());
  fix_->y_m(observed.observed_y_m());
  fix_->heading_rad(observed.observed_heading_rad());
}

void Agent::on_ledger(const msg::LedgerPage& page, MessageAttachment* attachment) {
  neighbours_.on_page(page, attachment);
}

void Agent::on_disturbance(const msg::Disturbance& disturbance) {
  if (disturbance.robot() != robot_.id || disturbance.disturbance_kind() != msg::DISTURBANCE_PLACE) return;
  const Vec2 position(disturbance.x_m(), disturbance.y_m());
  if (position.allFinite()) {
    placement_m_ = position;
  } else {
    ++invalid_;
  }
}

void Agent::on_coordinator_state(const msg::CoordinatorState& state, Time now) {
  negotiation_.on_coordinator_state(state, now);
}

Agent::VerdictResult Agent::on_verdict(const msg::Verdict& verdict, Time now) {
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

msg::Proposal Agent::propose_rest_version(Time now, Time start) {
  const Trajectory rest = Trajectory::resting(start, *placement_m_);
  return negotiation_.propose({&rest, 1}, 0, now);
}

msg::Command Agent::command(Time now) {
  if (forwarded_ && forwarded_->trajectory.start() <= now) forwarded_.reset();
  msg::Command command;
  command.robot(robot_.id);
  command.epoch(negotiation_.epoch());
  command.has_version(forwarded_.has_value());
  if (forwarded_) command.version(encode(*forwarded_));
  command.has_fix(fix_.has_value());
  if (fix_) command.fix(*fix_);
  fix_.reset();
  command.desired_heading_rad(goal().heading_rad.value_or(robot_.start_heading_rad));
  return command;
}

msg::AgentStatus Agent::status(Time now) const {
  msg::AgentStatus status;
  status.robot(robot_.id);
  const Negotiation& n = negotiation_;
  status.agent_state(!n.is_fenced()           ? msg::AGENT_FENCING
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
  status.reference_losses(reference_losses_);
  status.route_changes(last_choice_.changes);
  status.lost_versions(n.counts().lost);
  status.proposals(n.counts().proposals);
  status.grants(n.counts().grants);
  status.denials(n.counts().denials);
  status.invalid(n.counts().invalid + neighbours_.invalid() + obstacles_.invalid() + invalid_);
  return status;
}

}  // namespace sidestep
