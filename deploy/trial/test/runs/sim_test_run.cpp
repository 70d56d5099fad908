// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/runs/sim_test_run.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>

#include "deploy/trial/fault/fault_schedule.hpp"
#include "deploy/trial/simulate/system/sim_log.hpp"
#include "deploy/trial/test/runs/run_end.hpp"
#include "deploy/trial/test/runs/sim_faults.hpp"
#include "deploy/trial/test/runs/test_end.hpp"

namespace sidestep {
namespace {

constexpr Duration kStartupTimeout = std::chrono::seconds(20);
constexpr Duration kStep = std::chrono::milliseconds(50);

/// An observer's bus: it receives all messages without delay or loss.
struct ObserverBus {
  ObserverBus(SimSystem& system, const Scenario& scenario) : bus(system.network()) {
    bus.become_observer();
    bus.use_rules(SharedRules(scenario).fingerprint(), [](const TopicInfo&, const msg::Header&) {});
  }
  SimBus bus;
};

/// Runs the system until a coordinator grants; false on timeout.
bool run_until_granting(SimSystem& system, const RunObserver& observer) {
  const Time limit = system.begin() + kStartupTimeout;
  while (!observer.begin()) {
    if (!system.network().step(limit)) return false;
  }
  return true;
}

void play(const FaultTest& test, SimSystem& system, SimFaults& faults, FaultSchedule<PlannedFault>& schedule,
          Time zero) {
  TestEnd end(test);
  for (;;) {
    schedule.apply_due(system.now(), faults);
    faults.update();
    if (end.update(to_seconds(system.now() - zero), system.metrics().progress())) return;
    system.run_until(std::min({system.now() + kStep, schedule.next(), faults.next()}));
  }
}

}  // namespace

RunOutcome run_on_sim_bus(const FaultTest& test, std::uint64_t seed, LogLevel log_level) {
  SimSystem system(test.scenario, seed);
  if (log_level != LogLevel::kOff) log_events_of(system, log_level);
  ObserverBus observer_bus(system, test.scenario);
  RunObserver observer(observer_bus.bus);
  SimFaults faults(test, system, observer_bus.bus, observer);
  RunOutcome outcome;
  std::string abort_reason;
  if (run_until_granting(system, observer)) {
    FaultSchedule schedule(test.faults, *observer.begin());
    play(test, system, faults, schedule, *observer.begin());
    outcome.problems = schedule.problems();
    std::ranges::copy(faults.problems(), std::back_inserter(outcome.problems));
  } else {
    abort_reason = fmt::format("no coordinator granted within {} s", to_seconds(kStartupTimeout));
  }
  Report report = system.metrics().report();
  report.abort_reason = abort_reason;
  outcome.history = observer.history();
  outcome.history.end = run_end(report, observer, system.now());
  return outcome;
}

}  // namespace sidestep
