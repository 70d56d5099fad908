// SPDX-License-Identifier: Apache-2.0
#include "deploy/monitor/metrics/run_metrics.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

constexpr double kAtRest_mps = 0.02;
/// More lives of one process than any supervisor gives it: beyond it somebody is making them up.
constexpr std::size_t kMaxLives = 1000;

/// Who says nothing while others say so much is dead.
constexpr int kSilentAfter = 5;

/// The slot for a message in the list of its sender's lives, which are ordered by incarnation; nullptr when a
/// newer message of that life is there already, or there are too many lives.
template <typename Message>
Message* slot_for(std::vector<Message>& lives, const msg::Header& head) {
  const auto at =
      std::lower_bound(lives.begin(), lives.end(), head.incarnation(),
                       [](const Message& life, auto wanted) { return life.head().incarnation() < wanted; });
  if (at != lives.end() && at->head().incarnation() == head.incarnation()) {
    return head.message_number() > at->head().message_number() ? &*at : nullptr;
  }
  return lives.size() < kMaxLives ? &*lives.emplace(at) : nullptr;
}

/// Far from where differences of times overflow.
bool is_time(std::int64_t ns) { return ns >= 0 && ns < std::int64_t{1} << 62; }

bool is_sane(const msg::TruthRobot& robot) {
  return std::isfinite(robot.x_m()) && std::isfinite(robot.y_m()) && std::isfinite(robot.vx_mps()) &&
         std::isfinite(robot.vy_mps()) && std::isfinite(robot.reference_error_m());
}

DurationHistogram sum(const std::vector<msg::AgentStatus>& lives,
                      const msg::DurationCounts& (msg::AgentStatus::*counts)() const) {
  DurationHistogram total;
  for (const auto& life : lives) total.merge(DurationHistogram::from_message((life.*counts)()));
  return total;
}

std::uint64_t sum(const std::vector<msg::AgentStatus>& lives,
                  std::uint64_t (msg::AgentStatus::*count)() const) {
  std::uint64_t total = 0;
  for (const auto& life : lives) total += (life.*count)();
  return total;
}

}  // namespace

std::string agent_process(RobotId robot) { return "agent " + std::to_string(robot); }

std::string coordinator_process(int number) {
  return number == 0 ? "coordinator" : "coordinator " + std::to_string(number);
}

double straight_time_s(const RobotSpec& robot, const MotionLimits& limits) {
  const double f = limits.acceleration_mps2, d = limits.deceleration_mps2, v = limits.speed_mps;
  const double to_full_speed_m = v * v * (1 / f + 1 / d) / 2;
  Vec2 from = robot.start_m;
  double total_s = 0;
  for (const Goal& goal : robot.goals) {
    const double distance_m = (goal.position_m - from).norm();
    const double peak_mps = std::min(v, std::sqrt(2 * distance_m / (1 / f + 1 / d)));
    total_s += peak_mps * (1 / f + 1 / d) + std::max(0.0, distance_m - to_full_speed_m) / v;
    from = goal.position_m;
  }
  return total_s;
}

RunMetrics::RunMetrics(const Scenario& scenario) : scenario_(scenario) {
  for (const RobotSpec& spec : scenario.robots) {
    Watched robot;
    robot.spec = &spec;
    robot.position_m = spec.start_m;
    robots_.push_back(robot);
  }
}

RunMetrics::Watched* RunMetrics::find(RobotId robot) {
  const auto at =
      std::lower_bound(robots_.begin(), robots_.end(), robot,
                       [](const Watched& watched, RobotId wanted) { return watched.spec->id < wanted; });
  return at != robots_.end() && at->spec->id == robot ? &*at : nullptr;
}

const msg::AgentStatus* RunMetrics::Watched::speaks() const {
  const auto found = std::ranges::find(
      lives, speaker, [](const msg::AgentStatus& life) { return life.head().incarnation(); });
  return found == lives.end() ? nullptr : &*found;
}

double RunMetrics::to_go_m(const Watched& robot) const {
  return (robot.spec->goals.back().position_m - robot.position_m).norm();
}

bool RunMetrics::has_arrived(const Watched& robot) const {
  return robot.settled_since && robot.speaks() &&
         robot.speaks()->agent_state() == msg::AgentState::AGENT_ARRIVED;
}

void RunMetrics::on_truth(const msg::GroundTruth& truth) {
  const bool is_sound = std::isfinite(truth.penetration_m_s()) && !std::isnan(truth.min_clearance_m()) &&
                        std::isfinite(truth.crash_speed_mps()) &&
                        std::isfinite(truth.robot_crash_speed_mps()) && is_time(truth.at_ns());
  msg::GroundTruth* life = is_sound ? slot_for(simulators_, truth.head()) : nullptr;
  if (!life) {
    ++dropped_;
    return;
  }
  life->head(truth.head());
  life->contacts(truth.contacts());
  life->penetration_m_s(truth.penetration_m_s());
  life->min_clearance_m(truth.min_clearance_m());
  life->firmware_violations(truth.firmware_violations());
  life->crashes(truth.crashes());
  life->moving_crashes(truth.moving_crashes());
  life->crash_speed_mps(truth.crash_speed_mps());
  life->robot_crash_speed_mps(truth.robot_crash_speed_mps());
  if (life != &simulators_.back()) return;

  const Time at = time_from_ns(truth.at_ns());
  truth_at_ = at;
  for (const msg::TruthRobot& seen : truth.robots()) {
    Watched* robot = find(seen.robot());
    if (!robot || !is_sane(seen)) {
      ++dropped_;
      continue;
    }
    robot->position_m = {seen.x_m(), seen.y_m()};
    robot->speed_mps = std::hypot(seen.vx_mps(), seen.vy_mps());
    max_reference_error_m_ = std::max(max_reference_error_m_, seen.reference_error_m());
    const bool is_settled = to_go_m(*robot) <= scenario_.goal_tolerance_m && robot->speed_mps < kAtRest_mps;
    if (!is_settled)
      robot->settled_since.reset();
    else if (!robot->settled_since)
      robot->settled_since = at;
  }
}

void RunMetrics::on_status(const msg::AgentStatus& status) {
  Watched* robot = find(status.robot());
  const bool is_phase = status.agent_state() >= msg::AgentState::AGENT_FENCING &&
                        status.agent_state() <= msg::AgentState::AGENT_ABSENT;
  msg::AgentStatus* life = robot && is_phase ? slot_for(robot->lives, status.head()) : nullptr;
  if (!life) {
    ++dropped_;
    return;
  }
  *life = status;
  // One that its robot does not obey says nothing for it while another one speaks.
  const bool is_fencing = status.agent_state() == msg::AgentState::AGENT_FENCING;
  if (is_fencing && robot->speaks() && robot->speaker != status.head().incarnation() &&
      ++robot->others < kSilentAfter)
    return;
  robot->speaker = status.head().incarnation();
  robot->others = 0;
}

void RunMetrics::on_coordinator(const msg::CoordinatorState& state) {
  if (!is_time(state.head().stamp_ns())) {
    ++dropped_;
    return;
  }
  const std::pair life(state.coordinator(), static_cast<Incarnation>(state.head().incarnation()));
  if (coordinators_.size() >= kMaxLives && !coordinators_.count(life)) {
    ++dropped_;
    return;
  }
  CoordinatorLife& last = coordinators_[life];
  if (state.head().message_number() <= last.message_number) {
    ++dropped_;
    return;
  }
  last = {state.head().message_number(), state.invalid()};
  if (state.coordinator_mode() == msg::CoordinatorMode::COORDINATOR_STANDBY) return;
  if (active_ && state.epoch() < active_->epoch()) return;
  active_ = state;
  if (state.conflicts() > 0 && find(state.conflict_first()) && find(state.conflict_second()))
    conflicts_.emplace(state.conflict_first(), state.conflict_second());
  if (!granting_since_ && state.coordinator_mode() == msg::CoordinatorMode::COORDINATOR_GRANTING) {
    granting_since_ = time_from_ns(state.head().stamp_ns());
  }
}

void RunMetrics::on_death(const std::string& process, const std::string& reason, Time at, bool restarted) {
  const double at_s = granting_since_ ? to_seconds(at - *granting_since_) : 0;
  deaths_.push_back({process, reason, at_s, restarted});
}

int RunMetrics::arrived() const {
  return static_cast<int>(std::count_if(robots_.begin(), robots_.end(),
                                        [this](const Watched& robot) { return has_arrived(robot); }));
}

bool RunMetrics::all_arrived() const { return arrived() == static_cast<int>(robots_.size()); }

bool RunMetrics::all_at_rest() const {
  return std::all_of(robots_.begin(), robots_.end(),
                     [](const Watched& robot) { return robot.speed_mps < kAtRest_mps; });
}

std::vector<RobotId> RunMetrics::silent_agents() const {
  std::vector<RobotId> silent;
  for (const Watched& robot : robots_) {
    if (robot.lives.empty()) silent.push_back(robot.spec->id);
  }
  return silent;
}

std::vector<RobotId> RunMetrics::unregistered() const {
  if (!active_) return {};
  return {active_->missing().begin(), active_->missing().end()};
}

std::vector<RobotProgress> RunMetrics::progress() const {
  std::vector<RobotProgress> rows;
  for (const Watched& robot : robots_) {
    RobotProgress row;
    row.robot = robot.spec->id;
    row.team = robot.spec->team;
    if (robot.speaks()) row.phase = robot.speaks()->agent_state();
    row.arrived = has_arrived(robot);
    row.distance_to_go_m = to_go_m(robot);
    row.speed_mps = robot.speed_mps;
    row.grants = sum(robot.lives, &msg::AgentStatus::grants);
    row.denials = sum(robot.lives, &msg::AgentStatus::denials);
    const DurationHistogram negotiation = sum(robot.lives, &msg::AgentStatus::negotiation);
    row.negotiation_p50 = negotiation.quantile(0.5);
    row.negotiation_p99 = negotiation.quantile(0.99);
    rows.push_back(row);
  }
  return rows;
}

Report RunMetrics::report() const {
  Report report;
  report.scenario = scenario_.name;
  report.robots = static_cast<int>(robots_.size());
  report.arrived = arrived();
  for (const auto& life : simulators_) {
    report.contacts += life.contacts();
    report.penetration_m_s += life.penetration_m_s();
    report.firmware_violations += life.firmware_violations();
    report.crashes += life.crashes();
    report.moving_crashes += life.moving_crashes();
    report.crash_speed_mps = std::max(report.crash_speed_mps, life.crash_speed_mps());
    report.robot_crash_speed_mps = std::max(report.robot_crash_speed_mps, life.robot_crash_speed_mps());
    if (std::isfinite(life.min_clearance_m())) {
      report.min_clearance_m =
          std::min(report.min_clearance_m.value_or(life.min_clearance_m()), life.min_clearance_m());
    }
  }
  double latest_s = 0, total_s = 0, ratio = 0;
  int with_ratio = 0;
  for (const Watched& robot : robots_) {
    auto& arrival = report.arrival_s[robot.spec->id];
    if (has_arrived(robot) && granting_since_) {
      arrival = std::max(0.0, to_seconds(*robot.settled_since - *granting_since_));
      latest_s = std::max(latest_s, *arrival);
      total_s += *arrival;
      if (const double straight_s = straight_time_s(*robot.spec, scenario_.limits); straight_s > 0) {
        ratio += *arrival / straight_s;
        ++with_ratio;
      }
    }
    report.proposals += sum(robot.lives, &msg::AgentStatus::proposals);
    report.grants += sum(robot.lives, &msg::AgentStatus::grants);
    report.denials += sum(robot.lives, &msg::AgentStatus::denials);
    report.cycles += sum(robot.lives, &msg::AgentStatus::cycles);
    report.missed_cycles += sum(robot.lives, &msg::AgentStatus::missed_cycles);
    report.plan_changes += sum(robot.lives, &msg::AgentStatus::plan_changes);
    report.invalid_messages += sum(robot.lives, &msg::AgentStatus::invalid);
    report.negotiation.merge(sum(robot.lives, &msg::AgentStatus::negotiation));
    report.plan.merge(sum(robot.lives, &msg::AgentStatus::plan));
    report.search.merge(sum(robot.lives, &msg::AgentStatus::search));
  }
  for (const auto& [life, last] : coordinators_) report.invalid_messages += last.invalid;
  const double planned_s = static_cast<double>(report.cycles) * to_seconds(scenario_.cycle);
  if (planned_s > 0) report.plan_changes_per_s = static_cast<double>(report.plan_changes) / planned_s;
  if (report.arrived > 0 && granting_since_) report.mean_arrival_s = total_s / report.arrived;
  if (report.arrived == report.robots && granting_since_) report.makespan_s = latest_s;
  if (with_ratio > 0) report.arrival_over_straight = ratio / with_ratio;
  report.max_reference_error_m = max_reference_error_m_;
  for (const Watched& robot : robots_) {
    const msg::AgentStatus* status = robot.speaks();
    if (!status) continue;
    const double offset_s = std::abs(status->clock_offset_s());
    // A NaN fails both.
    if (!(status->clock_uncertainty_s() >= 0) || !(offset_s >= report.clock_offset_max_s.value_or(0)))
      continue;
    report.clock_offset_max_s = offset_s;
    report.clock_uncertainty_s = status->clock_uncertainty_s();
  }
  if (granting_since_ && truth_at_)
    report.robot_time_s = std::max(0.0, to_seconds(*truth_at_ - *granting_since_));
  report.deaths = deaths_;
  report.conflicts = conflicts_;
  if (auditor_) report.audit = auditor_->totals();
  return report;
}

}  // namespace sidestep
