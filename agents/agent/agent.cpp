// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/agent.hpp"

#include <utility>

namespace sidestep {
namespace {

/// Time from the end of a version until its robot rests, at most a base's latency later.
constexpr Duration kRestingTime{300'000'000};

const RobotSpec& spec_of(const FloorSpec& floor, RobotId robot) { return *find_robot(floor, robot); }

}  // namespace

Agent::Agent(const FloorSpec& floor, RobotId robot, Incarnation incarnation,
             std::shared_ptr<PlanningScratch> scratch)
    : robot_(spec_of(floor, robot)),
      scratch_(std::move(scratch)),
      cycle_(floor.cycle),
      negotiation_(robot, incarnation, floor.cycle),
      observations_(floor, robot_, scratch_->rules),
      orders_(floor, robot_),
      planner_(floor, robot_, *scratch_),
      search_(*scratch_),
      strangers_(scratch_->rules),
      courses_(robot, scratch_->rules),
      rng_(incarnation ^ (std::uint64_t{robot} << 40)) {}

bool Agent::on_robot_report(const RobotReport& robot_report) {
  negotiation_.on_robot_report(robot_report);
  observations_.on_robot_report(robot_report);
  if (negotiation_.is_fenced()) update_goal(robot_report);
  return negotiation_.is_contradicted();
}

void Agent::update_goal(const RobotReport& robot_report) {
  if (negotiation_.is_absent()) {
    planner_.on_absence();
    return orders_.on_absence();
  }
  if (!robot_report.is_lifted) placement_m_.reset();  // the robot has been put down
  if (orders_.on_execution(negotiation_.held().executing().trajectory, robot_report.valid_at))
    planner_.on_new_goal();
}

void Agent::on_orders(std::shared_ptr<const OrderPage> page) {
  const OrderExecution::Changes changes = orders_.on_page(std::move(page));
  if (changes.goal) planner_.on_new_goal();
  if (changes.zones) planner_.set_zones(assignment().zones());
}

void Agent::choose_order() {
  if (orders_.choose()) planner_.on_new_goal();
}

bool Agent::needs_other_coordinator(Time now) const {
  if (negotiation_.needs_other_coordinator(now)) return true;
  return negotiation_.may_propose(now) && !negotiation_.is_absent() &&
         observations_.is_coordinator_without_vision(now);
}

Registration Agent::registration() {
  Registration registration = negotiation_.registration();
  registration.has_moved |= observations_.own().has_moved();
  registration.knows_orders = assignment().is_known();
  return registration;
}

void Agent::on_coordinator_state(const CoordinatorHeartbeat& heartbeat, Time now) {
  negotiation_.on_coordinator_state(heartbeat, now);
  if (heartbeat.epoch != negotiation_.epoch() || heartbeat.epoch == 0) return;
  orders_.on_heartbeat(heartbeat);
  observations_.on_heartbeat(heartbeat, now);
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

WaitReason Agent::wait_reason(Time now) const {
  if (const WaitReason reason = negotiation_.wait_reason(now); reason != WaitReason::kNone) return reason;
  if (negotiation_.is_absent()) return WaitReason::kNone;
  if (is_stopping_) return WaitReason::kEnding;
  if (!assignment().is_known()) return WaitReason::kOrdersUnknown;
  if (assignment().is_held()) return WaitReason::kHeld;
  if (!assignment().goal() && !planner_.is_kept_out(observations_.own().estimate().position_m))
    return WaitReason::kNoOrder;
  return observations_.wait_reason(now);
}

std::optional<MotionPlan> Agent::plan(Time now, Time start, double max_speed_mps, Duration max_lag) {
  course_start_.reset();
  const WaitReason reason = wait_reason(now);
  // A robot without an order steps aside for others.
  const bool is_idle = reason == WaitReason::kNoOrder && observations_.wait_reason(now) == WaitReason::kNone;
  if ((reason != WaitReason::kNone && !is_idle) || negotiation_.is_absent()) {
    planner_.pause(now);
    return std::nullopt;
  }
  const Version& base = negotiation_.held().base_at(start);
  std::optional<MotionPlan> plan = planner_.plan({now, start, base, negotiation_.lead(), max_speed_mps,
                                                  max_lag, assignment(), observations_, courses_, rng_});
  if (plan) course_start_ = start + negotiation_.lead() * cycle_;
  return plan;
}

void Agent::plan_courses() {
  // The robot may have been lifted since the proposal.
  if (!course_start_ || !negotiation_.held().is_executing()) return;
  const Version& base = negotiation_.held().base_at(*course_start_);
  planner_.plan_courses(*course_start_, base.trajectory.state_at(*course_start_), rng_);
}

std::optional<Proposal> Agent::search(const MotionPlan& plan, Time now) {
  const Version& base = negotiation_.held().base_at(plan.query.start);
  const SearchResult result = search_.find(plan.query, base, observations_.neighbours(), rng_);
  strangers_.update(plan.query, result.desired_is_clear && !search_.is_creeping(), now);
  // A robot that creeps, or waits for a stranger at its goal, is not in a deadlock with other robots.
  const Goal* goal = assignment().goal();
  const bool waits = goal && strangers_.is_at(goal->position_m);
  planner_.on_search(plan, result.desired_is_clear || waits, now);
  if (result.count == 0) return std::nullopt;
  return negotiation_.propose({result.candidates.data(), result.count}, plan.base, now, plan.intent);
}

std::optional<Proposal> Agent::propose_rest_version(Time now, Time start) {
  if (is_stopping_ || !negotiation_.may_propose(now)) return std::nullopt;
  const auto rest_at = [&](const Vec2& place_m, VersionNumber base) {
    const Trajectory rest = Trajectory::resting(start, place_m);
    return negotiation_.propose({&rest, 1}, base, now);
  };
  if (negotiation_.is_absent()) return placement_m_ ? std::optional(rest_at(*placement_m_, 0)) : std::nullopt;
  const Version& base = negotiation_.held().base_at(start);
  const bool may_end = base.inflation_m > 0 && observations_.wait_reason(now) == WaitReason::kNone &&
                       observations_.may_end_inflation(base, start);
  if (!may_end || assignment().is_held()) return std::nullopt;
  return rest_at(base.trajectory.rest_position_m(), base.number);
}

bool Agent::is_at_rest(Time now) const {
  if (!negotiation_.is_fenced() || negotiation_.is_superseded() || negotiation_.is_absent()) return true;
  if (negotiation_.has_upcoming_version(now)) return false;
  return negotiation_.held().base_at(now).trajectory.end() + kRestingTime <= now;
}

Command Agent::command(Time now) {
  if (forwarded_ && forwarded_->trajectory.start() <= now) forwarded_.reset();
  Command command{robot_.id, negotiation_.incarnation(), negotiation_.command_epoch()};
  command.version = forwarded_;
  command.fix = observations_.take_fix();
  command.desired_heading_rad = orders_.desired_heading_rad();
  return command;
}

AgentActivity Agent::activity(Time now) const {
  return {negotiation_.is_fenced(),     negotiation_.is_superseded(), negotiation_.incarnation(),
          negotiation_.is_registered(), negotiation_.epoch(),         wait_reason(now),
          assignment().goal_index(),    orders_.has_arrived(),        planner_.is_recovering(),
          search_.is_escaping(),        strangers_.lasting()};
}

OrderReport Agent::order_report() const {
  OrderReport report = assignment().report();
  if (!assignment().goal()) return report;
  report.blockage = planner_.lasting_blockage();
  // A robot that has carried out its order only waits for others to pass.
  if (report.progress.is_finished() && report.blockage &&
      report.blockage->reason == msg::BlockReason::BLOCK_PASSING_ROBOT)
    report.blockage.reset();
  const bool has_cause = report.blockage && report.blockage->reason != msg::BlockReason::BLOCK_NO_PATH;
  if (const auto stranger = strangers_.lasting(); stranger && !has_cause) report.blockage = stranger;
  return report;
}

void Agent::count_drops(DropCounters& drops) const {
  const Negotiation::Counts& counts = negotiation_.counts();
  drops.count(DropReason::kUnproposedGrant, std::nullopt, counts.unproposed_grants);
  drops.count(DropReason::kUnexpectedVerdict, std::nullopt, counts.unexpected_verdicts);
  drops.count(DropReason::kLateFact, std::nullopt, counts.late_reports);
  drops.count(DropReason::kOldEpoch, std::nullopt, counts.old_epochs);
  observations_.count_drops(drops);
}

}  // namespace sidestep
