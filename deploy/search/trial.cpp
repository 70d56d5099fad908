// SPDX-License-Identifier: Apache-2.0
#include "deploy/search/trial.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "deploy/search/fault_draw.hpp"
#include "deploy/search/fault_player.hpp"
#include "deploy/search/motion_meter.hpp"
#include "deploy/search/promise_watch.hpp"
#include "deploy/search/scene_draw.hpp"

namespace sidestep {
namespace {

constexpr Duration kCalm = std::chrono::seconds(12);
// After so long without faults everybody has to be up again.
constexpr Duration kRecovery = std::chrono::seconds(2);
constexpr double kStill_m = 0.05;

std::string list(const std::vector<RobotId>& robots) { return fmt::format("{}", fmt::join(robots, ", ")); }

/// Robots that have an agent which does not drive, although nothing has been wrong for long.
std::vector<RobotId> not_driving(const SimSystem& system) {
  std::vector<RobotId> robots;
  for (const RobotProgress& row : system.judge().progress()) {
    const bool has_agent =
        system.is_alive(agent_process(row.robot)) || system.is_alive(twin_process(row.robot));
    const bool drives = row.phase == msg::AGENT_DRIVING || row.phase == msg::AGENT_ARRIVED;
    if (has_agent && !drives) robots.push_back(row.robot);
  }
  return robots;
}

void judge(const SimSystem& system, const PromiseWatch& watch, const MotionMeter& meter,
           TrialResult& result) {
  const Report report = system.judge().report();
  const auto fail = [&](const std::string& what) { result.failures.push_back(what); };
  result.contacts = report.contacts;
  result.promise_violations = watch.violations();
  result.firmware_violations = report.firmware_violations;
  result.proposals = report.proposals;
  result.grants = report.grants;
  result.denials = report.denials;
  result.min_clearance_m = report.min_clearance_m.value_or(result.min_clearance_m);
  result.moved_m = meter.total_m();
  result.calm_moved_m = meter.total_since_m();
  result.idle = static_cast<int>(meter.still(kStill_m).size());
  if (report.contacts > 0)
    fail(fmt::format("{} contacts, {:.6f} m s deep", report.contacts, report.penetration_m_s));
  if (watch.violations() > 0)
    fail(fmt::format("{} violations of the promise; {}", watch.violations(), watch.first()));
  if (report.firmware_violations > 0) fail(fmt::format("{} firmware violations", report.firmware_violations));
  if (watch.pages() == 0) fail("no coordinator has ever granted");
  if (const auto robots = not_driving(system); !robots.empty()) {
    fail(fmt::format("stuck: the agents of robots {} do not drive, long after the last fault", list(robots)));
  }
  const bool all_still = result.idle == result.robots;
  if (all_still && !system.judge().all_arrived()) fail("stuck: nobody moves, long after the last fault");
}

}  // namespace

Trial draw_trial(std::uint64_t seed, Duration duration, const std::optional<Scenario>& scenario) {
  Rng rng(seed);
  Rng for_scene = rng.fork(), for_faults = rng.fork();
  Trial trial{seed, scenario ? *scenario : draw_scene(for_scene), {}, duration};
  const Duration calm = std::min(kCalm, duration / 2);
  trial.plan =
      draw_faults(trial.scenario, SimSystem::process_names(trial.scenario), duration, calm, for_faults);
  return trial;
}

TrialResult run_trial(const Trial& trial, Report* report,
                      const std::function<void(const msg::GroundTruth&)>& on_truth) {
  const auto begin = std::chrono::steady_clock::now();
  TrialResult result;
  result.seed = trial.seed;
  result.robots = static_cast<int>(trial.scenario.robots.size());
  result.robot_s = result.robots * to_seconds(trial.duration);
  SimSystem system(trial.scenario, trial.seed, trial.plan.clocks);
  SimBus watch_bus(system.network());
  watch_bus.listen_aside();
  PromiseWatch watch(watch_bus, trial.scenario);
  MotionMeter meter(system.begin() + std::min(trial.plan.healed_at + kRecovery, trial.duration));
  system.on_truth([&](const msg::GroundTruth& truth) {
    meter.add(truth);
    if (on_truth) on_truth(truth);
  });
  FaultPlayer(system, trial.plan).run_until(trial.duration);
  judge(system, watch, meter, result);
  if (report) {
    *report = system.judge().report();
    report->must_arrive = false;
    report->failure = fmt::format("{}", fmt::join(result.failures, "; "));
  }
  result.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace sidestep
