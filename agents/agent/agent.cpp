// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/agent.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "agents/navigation/drift.hpp"
#include "common/messaging/codec.hpp"

namespace sidestep {
namespace {

const RobotSpec& spec_of(const Scenario& scenario, RobotId robot) { return *find_robot(scenario, robot); }

}  // namespace

Agent::Agent(const Scenario& scenario, RobotId robot, Incarnation incarnation,
             std::shared_ptr<PlanningScratch> bench)
    : robot_(spec_of(scenario, robot)),
      bench_(std::move(bench)),
      rules_(bench_->rules),
      clocks_differ_(from_seconds(2 * scenario.clock_bound_s)),
      cycle_(scenario.cycle),
      tracking_bound_m_(scenario.tracking_bound_m),
      goal_tolerance_m_(scenario.goal_tolerance_m),
      negotiation_(robot, incarnation, scenario.cycle),
      neighbours_(robot),
      obstacles_(scenario.opponent_speed_mps, clocks_differ_),
      rng_(incarnation ^ (std::uint64_t{robot} << 40)),
      estimate_{robot_.start_m, Vec2::Zero()} {
  neighbours_.look_about(robot_.start_m, page_horizon_m());
}

void Agent::on_feedback(const msg::Feedback& feedback) {
  negotiation_.on_feedback(feedback);
  const Vec2 position(feedback.x_m(), feedback.y_m()), velocity(feedback.vx_mps(), feedback.vy_mps());
  const Localisation known{feedback.deviation_m(), feedback.scale_deviation()};
  if (feedback.robot() != robot_.id || !position.allFinite() || !velocity.allFinite()) return;
  if (!(known.deviation_m >= 0) || !(known.scale_deviation >= 0)) return;
  estimate_ = {position, velocity};
  blind_path_m_ = blind_path_m(known, tracking_bound_m_);
  neighbours_.look_about(position, page_horizon_m());
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
  status.off_reference(off_reference_);
  status.plan_changes(last_choice_.changes);
  status.lost_versions(n.counts().lost);
  status.proposals(n.counts().proposals);
  status.grants(n.counts().grants);
  status.denials(n.counts().denials);
  status.invalid(n.counts().invalid + neighbours_.invalid() + obstacles_.invalid() + invalid_);
  return status;
}

}  // namespace sidestep
