// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <optional>

#include "common/messaging/senders.hpp"
#include "common/process/process.hpp"
#include "coordinator/coordinator_node.hpp"

int main(int argc, char** argv) {
  using namespace sidestep;
  bool is_standby = false;
  std::optional<CoordinatorNumber> number;
  const auto own_number = [&] { return number.value_or(is_standby ? 1 : 0); };
  Program program;
  program.name = "sidestep-coordinator";
  program.description =
      "Keeps the ledger of what every robot may be executing, and grants what is clear of it.";
  program.add_options = [&](CLI::App& app) {
    app.add_flag("--standby", is_standby, "listen, and take over when no other coordinator is heard");
    app.add_option("--number", number, "which of several coordinators it is; 0, or 1 with --standby")
        ->check(CLI::Range(CoordinatorNumber{0}, kMaxCoordinators - 1));
  };
  program.participant = [&] {
    return own_number() == 0 ? program.name : "coordinator-" + std::to_string(own_number());
  };
  program.fault_target = [&] { return static_cast<std::uint32_t>(Sender::kCoordinator) + own_number(); };
  program.start = [&](Bus& bus, const Scenario& scenario) -> std::shared_ptr<void> {
    const CoordinatorIdentity self{own_number(), static_cast<Incarnation>(to_ns(bus.now()))};
    return std::make_shared<CoordinatorNode>(bus, scenario, self, is_standby);
  };
  return run_process(argc, argv, program);
}
