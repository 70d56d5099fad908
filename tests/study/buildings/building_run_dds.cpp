// SPDX-License-Identifier: Apache-2.0
#include "tests/study/buildings/building_run_dds.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <optional>
#include <stdexcept>

#include "common/config/planner_names.hpp"
#include "common/config/scenario_loader.hpp"
#include "common/file/write_file.hpp"
#include "common/messaging/dds/free_domain.hpp"
#include "common/messaging/topics.hpp"
#include "common/yaml/yaml_document.hpp"
#include "deploy/run/launch/hosts/run_hosts.hpp"
#include "deploy/run/launch/launcher.hpp"
#include "deploy/run/launch/process_group.hpp"
#include "deploy/trial/simulate/campaign/distance_meter.hpp"

namespace sidestep {
namespace {

/// Writes the scenario to a file in another folder, without its goals, because a client sends the robots.
void write_without_goals(const std::string& file, const std::string& to) {
  YAML::Node scenario = parse_yaml(read_yaml_file(file, "a scenario"), file, "a scenario");
  for (YAML::Node robot : scenario["robots"]) robot.remove("goals_m");
  if (const YAML::Node map = scenario["map"]) {
    const auto folder = std::filesystem::absolute(file).parent_path();
    scenario["map"] = (folder / map.as<std::string>()).string();
  }
  write_file(to, YAML::Dump(scenario) + "\n");
}

/// Sends the robots to random positions while the launcher runs.
class DrivenRun {
 public:
  DrivenRun(Launcher& launcher, const Scenario& places, const BuildingRunOverDds& run)
      : launcher_(launcher), run_(run), trips_(launcher.bus(), places, run.seed) {
    launcher.bus().subscribe(topics::kTruth, [this](const msg::GroundTruth& truth) {
      if (!meter_) meter_.emplace(launcher_.bus().now());
      meter_->add(truth);
    });
    launcher.set_director({[] { return Time::max(); }, [this] { return act(); }});
  }

  BuildingResult run(const std::string& report_file) {
    const Report report = launcher_.run();
    write_report(report, report_file);
    if (!report.abort_reason.empty())
      throw std::runtime_error(fmt::format("{}: {}", report_file, report.abort_reason));
    return building_result(report, counts_, meter_ ? meter_->total_m() : 0);
  }

 private:
  bool act() {
    const Time now = launcher_.bus().now();
    if (!begun_at_) begun_at_ = now;
    const Duration over_time = now - *begun_at_ - run_.duration;
    if (over_time >= Duration::zero()) trips_.finish();
    trips_.update(now);
    counts_ = trips_.counts(now);
    return over_time >= Duration::zero() && (trips_.is_over() || over_time >= RandomTrips::kStuckAfter);
  }

  Launcher& launcher_;
  const BuildingRunOverDds& run_;
  RandomTrips trips_;
  TripCounts counts_;
  std::optional<DistanceMeter> meter_;
  std::optional<Time> begun_at_;
};

}  // namespace

BuildingResult run_building(const BuildingRunOverDds& run) {
  const Scenario places = load_scenario(run.scenario_file);
  const std::string stem =
      (std::filesystem::path(run.folder) / fmt::format("{}-{}-{}", places.name, run.planner, run.seed))
          .string();
  const FreeDomain domain;
  RunOptions options;
  options.scenario_file = stem + ".yaml";
  options.dds.domain = domain.number();
  options.dds.participant = "sidestep-study";
  options.floor.seed = run.seed;
  options.planner = run.planner;
  options.is_quiet = true;
  write_without_goals(run.scenario_file, options.scenario_file);
  const Scenario scenario = load_scenario(options.scenario_file);
  const RunHosts hosts(local_hosts(options.dds.interface), scenario);
  ProcessGroup processes(stem + ".log");
  Launcher launcher(options, scenario, hosts.placement(), hosts.network(), processes);
  return DrivenRun(launcher, places, run).run(stem + ".json");
}

}  // namespace sidestep
