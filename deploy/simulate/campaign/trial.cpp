// SPDX-License-Identifier: Apache-2.0
#include "deploy/simulate/campaign/trial.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "deploy/simulate/campaign/clock_sampler.hpp"
#include "deploy/simulate/campaign/fault_sampler.hpp"
#include "deploy/simulate/campaign/fault_player.hpp"
#include "deploy/simulate/campaign/motion_meter.hpp"
#include "deploy/simulate/campaign/scene_sampler.hpp"

namespace sidestep {
namespace {

constexpr Duration kCalm = std::chrono::seconds(12);
// After so long without faults everybody has to be up again.
constexpr Duration kRecovery = std::chrono::seconds(2);
constexpr double kStill_m = 0.05;

std::string list(const std::vector<RobotId>& robots) { return fmt::format("{}", fmt::join(robots, ", ")); }

/// Robots whose agents are not in the state in which they should be, although nothing has been wrong for
/// long.
struct Astray {
  std::vector<RobotId> not_driving, not_off_clock, driven_off_clock;
};

Astray find_astray(const SimSystem& system, const FaultPlan& plan) {
  Astray astray;
  for (const RobotProgress& row : system.judge().progress()) {
    const bool drives = row.phase == msg::AGENT_DRIVING || row.phase == msg::AGENT_ARRIVED;
    if (std::ranges::find(plan.off_clock, row.robot) == plan.off_clock.end()) {
      if (!drives) astray.not_driving.push_back(row.robot);
      continue;
    }
    if (row.phase != msg::AGENT_OFF_CLOCK) astray.not_off_clock.push_back(row.robot);
    if (row.grants > 0) astray.driven_off_clock.push_back(row.robot);
  }
  return astray;
}

/// Whether clocks were so far off that nothing may have been granted to their robots at all.
bool is_surely_noticed(const Trial& trial) {
  const auto is_far = [](Duration offset) { return std::chrono::abs(offset) > kSurelyNoticed; };
  return std::ranges::all_of(trial.plan.off_clock, [&](RobotId robot) {
    const auto coordinator = trial.plan.clocks.find("coordinator");
    const Duration reference = coordinator == trial.plan.clocks.end() ? Duration{0} : coordinator->second;
    return is_far(find_robot(trial.scenario, robot)->clock_offset - reference);
  });
}

void judge(const Trial& trial, const SimSystem& system, const MotionMeter& meter, TrialResult& result) {
  const Report report = system.judge().report();
  const auto fail = [&](const std::string& what) { result.failures.push_back(what); };
  result.contacts = report.contacts_of_its_own();
  result.contacts_by_hand = report.contacts - result.contacts;
  result.promise_violations = report.audit->violations;
  result.firmware_violations = report.firmware_violations;
  result.proposals = report.proposals;
  result.grants = report.grants;
  result.denials = report.denials;
  result.min_clearance_m = report.min_clearance_m.value_or(result.min_clearance_m);
  result.moved_m = meter.total_m();
  result.calm_moved_m = meter.total_since_m();
  result.idle = static_cast<int>(meter.still(kStill_m).size());
  if (result.contacts > 0)
    fail(fmt::format("{} contacts, {:.6f} m s deep", result.contacts, report.penetration_m_s));
  if (report.audit->violations > 0) {
    fail(fmt::format("{} violations found by the audit; {}", report.audit->violations,
                     to_line(report.audit->first.front())));
  }
  if (report.firmware_violations > 0) fail(fmt::format("{} firmware violations", report.firmware_violations));
  const bool may_move = static_cast<int>(trial.plan.off_clock.size()) < result.robots;
  if (may_move && report.grants == 0) fail("no coordinator has ever granted");
  const Astray astray = find_astray(system, trial.plan);
  if (!astray.not_driving.empty())
    fail(fmt::format("stuck: robots {} do not drive, long after the last fault", list(astray.not_driving)));
  if (!astray.not_off_clock.empty())
    fail(fmt::format("robots {} do not know that their clocks are wrong", list(astray.not_off_clock)));
  if (!astray.driven_off_clock.empty() && is_surely_noticed(trial))
    fail(fmt::format("robots {} were driven although their clocks are wrong", list(astray.driven_off_clock)));
  // Where some have to stand they may stand where others want to go.
  if (trial.plan.off_clock.empty() && result.idle == result.robots && !system.judge().all_arrived())
    fail("stuck: nobody moves, long after the last fault");
}

}  // namespace

Trial sample_trial(std::uint64_t seed, Duration duration, const std::optional<Scenario>& scenario) {
  Rng rng(seed);
  Rng for_scene = rng.fork(), for_faults = rng.fork(), for_clocks = rng.fork();
  Trial trial{seed, scenario ? *scenario : sample_scene(for_scene), {}, duration};
  const Duration calm = std::min(kCalm, duration / 2);
  trial.plan =
      sample_faults(trial.scenario, SimSystem::process_names(trial.scenario), duration, calm, for_faults);
  sample_clocks(trial.scenario, trial.plan, for_clocks);
  return trial;
}

TrialResult run_trial(const Trial& trial, Report* report,
                      const std::function<void(const msg::GroundTruth&)>& on_truth,
                      const std::function<void(SimSystem&)>& before, const std::function<void()>& after) {
  const auto begin = std::chrono::steady_clock::now();
  TrialResult result;
  result.seed = trial.seed;
  result.robots = static_cast<int>(trial.scenario.robots.size());
  result.robot_s = result.robots * to_seconds(trial.duration);
  SimSystem system(trial.scenario, trial.seed, trial.plan.clocks);
  MotionMeter meter(system.begin() + std::min(trial.plan.healed_at + kRecovery, trial.duration));
  system.on_truth([&](const msg::GroundTruth& truth) {
    meter.add(truth);
    if (on_truth) on_truth(truth);
  });
  if (before) before(system);
  FaultPlayer(system, trial.plan).run_until(trial.duration);
  if (after) after();
  judge(trial, system, meter, result);
  if (report) {
    *report = system.judge().report();
    report->must_arrive = false;
    report->failure = fmt::format("{}", fmt::join(result.failures, "; "));
  }
  result.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace sidestep
