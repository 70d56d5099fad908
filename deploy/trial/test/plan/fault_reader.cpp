// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/plan/fault_reader.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <functional>
#include <iterator>
#include <optional>

#include "common/config/scenario_loader.hpp"
#include "deploy/trial/simulate/system/system_processes.hpp"
#include "deploy/trial/test/plan/disturbance_reader.hpp"
#include "deploy/trial/test/plan/plan_names.hpp"

namespace sidestep {
namespace {

constexpr Range kFaultSeconds{0.001, 3600};

/// Reads one fault.
class FaultReader {
 public:
  FaultReader(YamlMap& map, const Scenario& scenario, const std::string& folder)
      : map_(map), scenario_(scenario), folder_(folder), processes_(system_process_names(scenario)) {}

  PlannedFault read() {
    PlannedFault fault;
    fault.at_s = moment_from(map_, "at_s", scenario_);
    ProcessNames keys{"kill", "restart", "pause", "partition", "network", "twin", "attest_absence"};
    std::ranges::copy(disturbance_keys(), std::back_inserter(keys));
    key_ = only_key_of(map_, keys, "a fault");
    fault.action = read_action();
    fault.seconds = seconds_;
    fault.text = fmt::format("{} {}", key_, subject_);
    if (fault.end_s() > scenario_.time_limit_s)
      map_.location_of("seconds").fail(fmt::format("the fault ends at {:g} s, after the time limit of {:g} s",
                                                   fault.end_s(), scenario_.time_limit_s));
    return fault;
  }

 private:
  FaultAction read_action() {
    if (key_ == "kill") return Kill{read_running_process()};
    if (key_ == "restart") return read_restart();
    if (key_ == "pause") {
      (void)map_.require("seconds");
      read_seconds();
      return Pause{{read_running_process()}};
    }
    if (key_ == "partition") return read_partition();
    if (key_ == "network") return read_impairment();
    if (key_ == "twin") return TwinFault{read_robot()};
    if (key_ == "attest_absence") return AbsenceFault{read_robot()};
    const RobotDisturbance disturbance = read_disturbance(map_, key_, scenario_);
    subject_ = fmt::format("robot {}", disturbance.robot);
    if (has_duration(disturbance)) seconds_ = to_seconds(disturbance.duration);
    return disturbance;
  }

  RobotId read_robot() {
    const RobotId robot = robot_from(map_, key_, scenario_);
    subject_ = fmt::format("robot {}", robot);
    return robot;
  }

  /// Reads the name of a process. A second agent and the active coordinator may also be named.
  std::string read_running_process() {
    ProcessNames names = processes_;
    names.emplace_back(kActiveCoordinator);
    for (const RobotSpec& robot : scenario_.robots) names.push_back(twin_process(robot.id));
    return subject_ = process_from(map_, key_, names);
  }

  void read_seconds() { seconds_ = map_.number("seconds", kFaultSeconds); }

  RestartFault read_restart() {
    ProcessNames names = processes_;
    std::erase(names, "simulator");  // the simulator holds the ground truth
    RestartFault fault{subject_ = process_from(map_, key_, names), {}};
    const auto file = map_.text("scenario");
    if (!file) return fault;
    const YamlLocation location = map_.location_of("scenario");
    fault.scenario_file = (std::filesystem::path(folder_) / *file).string();
    const ProcessNames others = system_process_names(load_scenario(fault.scenario_file));
    const bool is_agent = fault.process.starts_with("agent ");
    if (is_agent && std::ranges::find(others, fault.process) == others.end())
      location.fail(fmt::format("the other scenario has no {}", fault.process));
    return fault;
  }

  Partition read_partition() {
    const ProcessNames group = processes_from(map_, key_, processes_);
    subject_ = fmt::format("{}{}", group.front(), group.size() > 1 ? " and others" : "");
    const auto is_in_group = [&](const std::string& process) {
      return std::ranges::find(group, process) != group.end();
    };
    ProcessNames others;
    if (const auto from = find_processes(map_, "from", processes_))
      others = *from;
    else
      std::ranges::copy_if(processes_, std::back_inserter(others), std::not_fn(is_in_group));
    const auto both = std::ranges::find_if(others, is_in_group);
    if (both != others.end()) map_.location_of("from").fail(*both + " is on both sides");
    if (others.empty()) map_.location_of(key_).fail("no process is on the other side");
    const auto one_way = find_process(map_, "one_way", {"in", "out"});
    read_seconds();
    return one_way == "in" ? Partition{others, group, false} : Partition{group, others, !one_way};
  }

  ImpairmentFault read_impairment() {
    ProcessNames names = processes_;
    names.emplace_back("all");
    ImpairmentFault fault{subject_ = process_from(map_, key_, names), kUnimpairedLink};
    map_.read("loss", {0, 1}, fault.quality.loss);
    map_.read("burst", {1, 1e6}, fault.quality.mean_burst);
    map_.read("duplicate", {0, 1}, fault.quality.duplicate);
    map_.read("cut", fault.quality.is_cut);
    read_delays(fault.quality);
    read_seconds();
    bool is_clear = false;
    map_.read("clear", is_clear);
    if (map_.schema()) return fault;
    if (is_clear != (fault.quality == kUnimpairedLink))
      map_.location_of(key_).fail(is_clear
                                      ? "clear cannot be combined with a fault"
                                      : "expected one of the keys loss, delay_ms, duplicate, cut, clear");
    if (fault.quality.mean_burst > 1 && fault.quality.loss <= 0)
      map_.location_of("burst").fail("requires loss");
    if (is_clear && seconds_) map_.location_of("seconds").fail("cannot be combined with clear");
    return fault;
  }

  void read_delays(LinkQuality& quality) {
    const auto delays_ms = map_.numbers("delay_ms", 3, 3, {0, 10000});
    if (!delays_ms) return;
    quality.delay_min = from_seconds((*delays_ms)[0] * 1e-3);
    quality.delay_mean = from_seconds((*delays_ms)[1] * 1e-3);
    quality.delay_max = from_seconds((*delays_ms)[2] * 1e-3);
    if (!std::ranges::is_sorted(*delays_ms))
      map_.location_of("delay_ms").fail("expected MIN, MEAN, MAX in increasing order");
  }

  YamlMap& map_;
  const Scenario& scenario_;
  const std::string& folder_;
  ProcessNames processes_;
  std::string key_, subject_;
  std::optional<double> seconds_;
};

}  // namespace

std::vector<PlannedFault> read_faults(YamlMap& map, const Scenario& scenario, const std::string& folder) {
  std::vector<PlannedFault> faults;
  read_optional_list(map, "faults", 1, kMaxFaults,
                     [&](YamlMap& inner) { faults.push_back(FaultReader(inner, scenario, folder).read()); });
  return faults;
}

}  // namespace sidestep
