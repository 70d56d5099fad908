// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>

#include "common/messaging/senders.hpp"
#include "common/process/process.hpp"
#include "simulator/simulator_node.hpp"

int main(int argc, char** argv) {
  std::uint64_t seed = 1;
  sidestep::Program program;
  program.name = "sidestep-simulator";
  program.description = "The floor: robot bodies and their firmware, the ball, and the cameras over it.";
  program.add_options = [&seed](CLI::App& app) {
    app.add_option("--seed", seed, "of all noise and loss")->capture_default_str();
  };
  program.fault_target = [] { return static_cast<std::uint32_t>(sidestep::Sender::kSimulator); };
  program.start = [&seed](sidestep::Bus& bus, const sidestep::Scenario& scenario) -> std::shared_ptr<void> {
    const auto incarnation = static_cast<sidestep::Incarnation>(sidestep::to_ns(bus.now()));
    return std::make_shared<sidestep::SimulatorNode>(bus, scenario, incarnation, seed);
  };
  return sidestep::run_process(argc, argv, program);
}
