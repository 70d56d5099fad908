// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/trial.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iterator>

#include "deploy/trial/simulate/campaign/base_sampler.hpp"
#include "deploy/trial/simulate/campaign/clock_sampler.hpp"
#include "deploy/trial/simulate/campaign/distance_meter.hpp"
#include "deploy/trial/simulate/campaign/disturbance_sampler.hpp"
#include "deploy/trial/simulate/campaign/fault_player.hpp"
#include "deploy/trial/simulate/campaign/fault_sampler.hpp"
#include "deploy/trial/simulate/campaign/order_sampler.hpp"
#include "deploy/trial/simulate/campaign/reception_sampler.hpp"
#include "deploy/trial/simulate/campaign/robot_ends.hpp"
#include "deploy/trial/simulate/campaign/scene_sampler.hpp"
#include "deploy/trial/simulate/campaign/sent_messages.hpp"

namespace sidestep {
namespace {

// Time after the last fault within which all processes must work again.
constexpr Duration kRecoveryTime = std::chrono::seconds(2);
/// Longest time that a robot waits, for example after its own stop, unless it is stuck.
constexpr Duration kMaxRobotWait = std::chrono::seconds(3);
// With more ghosts, there are always some that look like approaching obstacles, and robots on a small floor
// never move.
constexpr double kMaxGhostObstacles = 0.02;
constexpr double kStationaryDistance_m = 0.05;

std::string list(const std::vector<RobotId>& robots) { return fmt::format("{}", fmt::join(robots, ", ")); }

/// Robots whose agents are in a wrong state at the end, long after the last fault.
struct UnexpectedStates {
  std::vector<RobotId> not_driving;
  /// Robots whose clock is out of bounds, but whose agent does not report it.
  std::vector<RobotId> undetected_clock;
  /// Robots whose clock is out of bounds, but to which versions were granted.
  std::vector<RobotId> driven;
  std::vector<RobotId> not_absent;  ///< robots off the floor whose agent does not report it
};

bool is_driving(const RobotProgress& row) {
  return row.agent_state == msg::AgentState::AGENT_DRIVING ||
         row.agent_state == msg::AgentState::AGENT_ARRIVED;
}

UnexpectedStates find_unexpected_states(const std::vector<RobotProgress>& progress, const FaultPlan& plan) {
  UnexpectedStates unexpected;
  for (const RobotProgress& row : progress) {
    const auto end = plan.ends.find(row.robot);
    if (end == plan.ends.end()) {
      if (!is_driving(row)) unexpected.not_driving.push_back(row.robot);
    } else if (end->second == RobotEnd::kClockOutOfBound || end->second == RobotEnd::kClockLeftBound) {
      if (row.agent_state != msg::AgentState::AGENT_CLOCK_OUT_OF_BOUND)
        unexpected.undetected_clock.push_back(row.robot);
      if (end->second == RobotEnd::kClockOutOfBound && row.grants > 0) unexpected.driven.push_back(row.robot);
    } else if (end->second == RobotEnd::kLifted && row.agent_state != msg::AgentState::AGENT_ABSENT) {
      unexpected.not_absent.push_back(row.robot);
    }
  }
  return unexpected;
}

/// Removes pauses of the process that drives bases: bases that get no commands leave their versions, which
/// the protocol assumes never happens.
void remove_driver_pauses(FaultPlan& plan) {
  for (TimedFault& timed : plan.faults) {
    if (auto* const pause = std::get_if<Pause>(&timed.fault)) std::erase(pause->processes, "simulator");
  }
}

/// Whether every clock out of bound is so far out that no version may have been granted to its robot.
bool is_detection_certain(const Trial& trial) {
  const auto is_large = [](Duration offset) { return std::chrono::abs(offset) > kCertainlyDetectedOffset; };
  return std::ranges::all_of(robots_with(trial.plan, RobotEnd::kClockOutOfBound), [&](RobotId robot) {
    const auto coordinator = trial.plan.clocks.find("coordinator");
    const Duration reference =
        coordinator == trial.plan.clocks.end() ? Duration{0} : coordinator->second.offset;
    return is_large(find_robot(trial.scenario, robot)->clock_offset - reference);
  });
}

void copy_metrics(const Report& report, const DistanceMeter& meter, TrialResult& result) {
  result.contacts = report.unexcused_contacts();
  result.excused_contacts = report.audit->excused_contacts;
  for (const ExcusedContacts& excused : report.audit->excused)
    result.excused_by_cause[excused.cause] += excused.contacts;
  result.pair_s = report.audit->pair_s;
  result.excused_pair_s = report.audit->excused_pair_s;
  result.audit_violations = report.audit->violations;
  result.firmware_violations = report.firmware_violations;
  result.proposals = report.proposals;
  result.grants = report.grants;
  result.denials = report.denials;
  result.min_clearance_m = report.min_clearance_m.value_or(result.min_clearance_m);
  result.distance_m = meter.total_m();
  result.distance_after_recovery_m = meter.recent_total_m();
  result.stationary = static_cast<int>(meter.stationary_robots(kStationaryDistance_m).size());
}

}  // namespace

void add_failures(const Trial& trial, const std::vector<RobotProgress>& progress, bool has_arrived,
                  const Report& report, TrialResult& result) {
  const auto fail = [&](const std::string& failure) { result.failures.push_back(failure); };
  if (result.contacts > 0)
    fail(fmt::format("{} contacts, {:.6f} m s of penetration", result.contacts, report.penetration_m_s));
  if (report.audit->violations > 0 && result.is_audited) {
    fail(fmt::format("{} audit violations, the first: {}", report.audit->violations,
                     to_line(report.audit->first.front())));
  }
  if (report.audit->verdict() == AuditVerdict::kNotJudged && result.is_audited)
    fail("the audit did not judge the run: " + shortfall(*report.audit));
  if (report.firmware_violations > 0) fail(fmt::format("{} firmware violations", report.firmware_violations));
  const std::vector<RobotId> out_of_bound = robots_with(trial.plan, RobotEnd::kClockOutOfBound);
  const bool may_move = static_cast<int>(out_of_bound.size()) < result.robots;
  if (may_move && report.grants == 0) fail("no coordinator ever granted");
  const UnexpectedStates unexpected = find_unexpected_states(progress, trial.plan);
  if (!unexpected.not_driving.empty()) {
    fail(fmt::format("stuck: robots {} do not drive, long after the last fault",
                     list(unexpected.not_driving)));
  }
  if (!unexpected.undetected_clock.empty()) {
    fail(fmt::format("the agents of robots {} do not detect that their clocks are out of bound",
                     list(unexpected.undetected_clock)));
  }
  if (!unexpected.not_absent.empty()) {
    fail(fmt::format("the agents of robots {} do not report that their robots are off the floor",
                     list(unexpected.not_absent)));
  }
  if (!unexpected.driven.empty() && is_detection_certain(trial)) {
    fail(
        fmt::format("robots {} were driven although their clocks are out of bound", list(unexpected.driven)));
  }
  // Robots that must not move may occupy the goals of other robots.
  const bool may_block = std::ranges::any_of(trial.plan.ends, [](const auto& entry) {
    return entry.second != RobotEnd::kLifted && entry.second != RobotEnd::kTakenAway;
  });
  if (!may_block && result.stationary == result.robots && !has_arrived)
    fail("stuck: no robot moves, long after the last fault");
}

std::set<std::string> Trial::fault_kinds() const {
  std::set<std::string> kinds = sidestep::fault_kinds(scenario, plan);
  if (bases) kinds.merge(sidestep::fault_kinds(*bases));
  return kinds;
}

std::string Trial::summary() const {
  return bases ? to_text(*bases) + "; " + scene_summary(scenario) : scene_summary(scenario);
}

Trial sample_trial(std::uint64_t seed, Duration duration, const std::optional<Scenario>& scenario,
                   bool has_faults) {
  Rng rng(seed);
  Rng scene_rng = rng.fork(), fault_rng = rng.fork(), clock_rng = rng.fork(), disturbance_rng = rng.fork(),
      opponent_rng = rng.fork(), planner_rng = rng.fork(), laser_rng = rng.fork(), reception_rng = rng.fork(),
      clock_jump_rng = rng.fork(), order_rng = rng.fork(), base_rng = rng.fork();
  Trial trial{seed, {}, {}, duration};
  if (scenario) {
    trial.scenario = *scenario;
  } else {
    trial.bases = sample_driven_bases(base_rng);
    trial.scenario = sample_scene(scene_rng, trial.bases);
    sample_planners(trial.scenario, planner_rng);
  }
  // The simulator of bases has neither people nor lasers.
  if (!scenario && !trial.bases) {
    sample_opponents(trial.scenario, opponent_rng);
    sample_lasers(trial.scenario, laser_rng);
  }
  const FaultTimes times(duration - std::min(kFaultFreeEnd, duration / 2), fault_rng);
  FaultPlan& plan = trial.plan;
  plan.healed_at = times.healed_at();
  if (!has_faults) return trial;
  plan = sample_faults(trial.scenario, system_process_names(trial.scenario), times, fault_rng);
  if (trial.bases) remove_driver_pauses(plan);
  sample_clocks(trial.scenario, plan, duration, !trial.bases, clock_rng);
  if (disturbance_rng.chance(0.08)) trial.scenario.vision.ghost_probability = disturbance_rng.uniform(0, 0.2);
  if (disturbance_rng.chance(0.08))
    trial.scenario.vision.ghost_obstacle_probability = disturbance_rng.uniform(0, kMaxGhostObstacles);
  // Only robots with firmware have these disturbances.
  if (!trial.bases) sample_disturbances(trial.scenario, times, plan, disturbance_rng);
  sample_reception(trial.scenario, times, plan, reception_rng);
  sample_clock_jumps(trial.scenario, times, plan, clock_jump_rng);
  sample_orders(trial.scenario, times, plan, order_rng);
  std::ranges::stable_sort(plan.faults, {}, &TimedFault::at);
  return trial;
}

TrialResult run_trial(const Trial& trial, Report* report, const TrialHooks& hooks) {
  const auto begin = std::chrono::steady_clock::now();
  TrialResult result;
  result.seed = trial.seed;
  result.robots = static_cast<int>(trial.scenario.robots.size());
  result.fault_kinds = trial.fault_kinds();
  result.robot_s = result.robots * to_seconds(trial.duration);
  SimSystem system(trial.scenario, trial.seed, trial.plan.clocks, SimSystem::kBegin, trial.bases);
  DistanceMeter meter(system.begin() + std::min(trial.plan.healed_at + kRecoveryTime, trial.duration));
  system.observer_bus().subscribe(topics::kTruth, [&](const msg::GroundTruth& truth) { meter.add(truth); });
  const SentMessages sent(system.observer_bus(), trial.scenario);
  if (hooks.on_start) hooks.on_start(system);
  FaultPlayer player(system, trial.scenario, trial.plan);
  player.run_until(trial.duration - std::min(trial.duration, kMaxRobotWait));
  const std::vector<RobotProgress> earlier = system.metrics().progress();
  player.run_until(trial.duration);
  if (hooks.on_end) hooks.on_end();
  const Report final_report = system.metrics().report();
  copy_metrics(final_report, meter, result);
  result.is_audited = !system.was_second_simulator_accepted();
  Trial judged = trial;
  judged.plan.ends =
      robot_ends(trial.plan, trial.scenario, system.started_at("simulator") - system.begin(), trial.duration);
  std::vector<RobotProgress> progress = system.metrics().progress();
  for (std::size_t i = 0; i < progress.size(); ++i) {
    if (!judged.plan.ends.contains(progress[i].robot) && is_driving(earlier[i]))
      progress[i].agent_state = earlier[i].agent_state;
  }
  add_failures(judged, progress, system.metrics().all_arrived(), final_report, result);
  std::ranges::copy(player.order_failures(), std::back_inserter(result.failures));
  std::ranges::copy(sent.failures(), std::back_inserter(result.failures));
  if (report) {
    *report = final_report;
    report->trace = system.metrics().floor_trace();
    report->must_arrive = false;
    if (!result.is_audited) report->audit->exemption = "a process accepted a second simulator";
    report->abort_reason = fmt::format("{}", fmt::join(result.failures, "; "));
  }
  result.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace sidestep
