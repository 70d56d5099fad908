// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <stdexcept>

#include "common/process/process.hpp"
#include "coordinator/coordinator_node.hpp"

int main(int argc, char** argv) {
  using namespace sidestep;
  Program program;
  program.name = "sidestep-coordinator";
  program.description =
      "Keeps the ledger of what every robot may be executing, and grants what is clear of it.";
  program.start = [](Bus& bus, const Scenario& scenario) -> std::shared_ptr<void> {
    auto node = std::make_shared<CoordinatorNode>(bus, scenario, static_cast<Incarnation>(to_ns(bus.now())));
    node->on_superseded([] { throw std::runtime_error("superseded by another coordinator"); });
    return node;
  };
  return run_process(argc, argv, program);
}
