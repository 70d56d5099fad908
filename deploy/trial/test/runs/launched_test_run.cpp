// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/runs/launched_test_run.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>
#include <string>

#include "common/file/new_file.hpp"
#include "deploy/run/launch/other_run.hpp"
#include "deploy/run/launch/process_group.hpp"
#include "deploy/run/launch/process_keys.hpp"
#include "deploy/trial/fault/fault_schedule.hpp"
#include "deploy/trial/test/runs/launched_faults.hpp"
#include "deploy/trial/test/runs/run_end.hpp"
#include "deploy/trial/test/runs/test_end.hpp"

namespace sidestep {
namespace {

Hosts hosts_of(const FaultTest& test, const LaunchOptions& options) {
  if (!options.hosts_file.empty()) return load_hosts(options.hosts_file);
  return has_fault<Partition>(test) ? hosts_for_partitions(test) : local_hosts(options.dds.interface);
}

RunOptions run_options(const FaultTest& test, const LaunchOptions& options, const RunHosts& hosts) {
  RunOptions run;
  run.scenario_file = test.file;
  run.hosts_file = options.hosts_file;
  run.report_file = default_report_path(test.scenario.name, std::nullopt);
  run.dds = options.dds;
  run.dds.participant = "sidestep-test";
  run.dds.identity = {Role::kJudge};
  run.dds.interface = hosts.hosts().interface;
  run.floor.seed = options.seed;
  run.log_level = options.log_level;
  run.faults = has_fault<ImpairmentFault>(test);
  run.is_quiet = true;
  require_keys(run, test.scenario);
  return run;
}

DdsSettings operator_settings(const RunOptions& options) {
  DdsSettings dds = options.dds;
  dds.identity = {Role::kOperator};
  return dds;
}

/// Plays the faults of a test while the launcher runs.
class LaunchedTestRun {
 public:
  LaunchedTestRun(const FaultTest& test, const RunHosts& hosts, const RunOptions& options, Launcher& launcher)
      : test_(test),
        options_(options),
        launcher_(launcher),
        observer_(launcher.bus()),
        faults_(test, hosts, operator_settings(options), launcher, observer_),
        end_(test) {
    launcher.set_director({[this] { return next(); }, [this] { return act(); }});
  }

  RunOutcome run() {
    const Report report = launcher_.run();
    RunOutcome outcome;
    if (schedule_) outcome.problems = schedule_->problems();
    std::ranges::copy(faults_.problems(), std::back_inserter(outcome.problems));
    outcome.history = observer_.history();
    outcome.history.end = run_end(report, observer_, ended_at_.value_or(launcher_.bus().now()));
    if (const std::string problem = try_write_report(report, options_.report_file); !problem.empty())
      outcome.problems.push_back({outcome.history.end.at_s, "write the report: " + problem});
    else
      outcome.report_file = options_.report_file;
    return outcome;
  }

 private:
  Time next() const { return schedule_ ? schedule_->next() : Time::max(); }

  bool act() {
    const Time now = launcher_.bus().now();
    if (!schedule_) {
      // The launcher's metrics already know that a coordinator grants.
      observer_.begin_at(now);
      schedule_.emplace(test_.faults, *observer_.begin());
    }
    schedule_->apply_due(now, faults_);
    faults_.update();
    ended_at_ = now;
    return end_.update(to_seconds(now - *observer_.begin()), launcher_.metrics().progress());
  }

  const FaultTest& test_;
  const RunOptions& options_;
  Launcher& launcher_;
  RunObserver observer_;
  LaunchedFaults faults_;
  TestEnd end_;
  std::optional<FaultSchedule<PlannedFault>> schedule_;
  std::optional<Time> ended_at_;
};

}  // namespace

RunOutcome run_over_dds(const FaultTest& test, const LaunchOptions& options) {
  const RunHosts hosts(hosts_of(test, options), test.scenario);
  RunOptions run = run_options(test, options, hosts);
  require_free_domain(run.dds);
  // Another run of the scenario may start in the same second.
  const std::string log_file =
      create_new_file(std::filesystem::path(run.report_file).replace_extension(".log").string());
  run.report_file = std::filesystem::path(log_file).replace_extension(".json").string();
  ProcessGroup processes(log_file);
  Launcher launcher(run, test.scenario, hosts.placement(), hosts.network(), processes);
  RunOutcome outcome = LaunchedTestRun(test, hosts, run, launcher).run();
  outcome.log_file = log_file;
  return outcome;
}

}  // namespace sidestep
