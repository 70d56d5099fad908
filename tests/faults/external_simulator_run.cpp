// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/external_simulator_run.hpp"

#include <csignal>
#include <fmt/format.h>

#include "tests/catch.hpp"

namespace sidestep {
namespace {

const std::string kRobots = "--robots=";

}  // namespace

ExternalSimulatorRun::ExternalSimulatorRun(const std::string& scenario,
                                           const std::vector<std::string>& simulator_options,
                                           const std::vector<std::string>& run_options, bool has_truth)
    : simulator_options_(simulator_options), has_truth_(has_truth) {
  std::string driver = "--latency-ms 119";
  std::vector<std::string> options;
  for (const std::string& option : run_options) {
    if (option.starts_with(kRobots))
      driver = option.substr(kRobots.size());
    else
      options.push_back(option == "--place" ? "--place=" + to_text(control()) : option);
  }
  options.insert(options.begin(), {"--driver", "league",
                                   fmt::format("{}{} --blue {} --yellow {}", kRobots, driver, to_text(blue()),
                                               to_text(yellow())),
                                   fmt::format("--vision=--source ssl --ssl-vision {}", endpoints_.text(0))});
  run_ = std::make_unique<LaunchedRun>(scenario, options);
  start_simulator();
}

void ExternalSimulatorRun::start_simulator(const std::vector<std::string>& options) {
  std::vector<std::string> arguments{
      "--scenario",     run_->scenario_file(), "--league", "--ssl-vision",  endpoints_.text(0),
      "--control",      to_text(control()),    "--blue",   to_text(blue()), "--yellow",
      to_text(yellow())};
  // Without ground truth, the simulator gets a DDS domain in which no process receives its messages.
  const auto dds = has_truth_
                       ? run_->dds_arguments()
                       : std::vector<std::string>{"--domain", std::to_string(endpoints_.domain().number())};
  arguments.insert(arguments.end(), dds.begin(), dds.end());
  arguments.insert(arguments.end(), options.begin(), options.end());
  simulator_ = run_->start(fmt::format("foreign simulator {}", ++starts_), "sidestep-simulator", arguments);
}

void ExternalSimulatorRun::kill_simulator() {
  REQUIRE(kill(simulator_, SIGKILL) == 0);
  const std::string name = fmt::format("foreign simulator {}", starts_);
  REQUIRE(run_->wait_until([&] { return run_->exit_reason(name).has_value(); }));
}

}  // namespace sidestep
