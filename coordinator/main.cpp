// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include "common/log/log.hpp"
#include "common/process/command_line.hpp"
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
      "Keeps the ledger of the versions that robots may execute, and grants versions that are clear of it.";
  program.add_options = [&](const CliCommand& app) {
    app.add_flag("--standby", is_standby, "listen, and take over when no other coordinator is active");
    app.add_option("--number", number,
                   "number of this coordinator among several; default 0, or 1 with --standby")
        .check(in_range(CoordinatorNumber{0}, kMaxCoordinators - 1));
  };
  program.participant = [&] {
    return own_number() == 0 ? program.name : "coordinator-" + std::to_string(own_number());
  };
  program.process = [&] { return process_of(own_number()); };
  program.clock_reference = ClockReference::kRobots;
  program.start = [&](Bus& bus, const Scenario& scenario, Incarnation incarnation) -> RunningNodes {
    const CoordinatorIdentity self{own_number(), incarnation};
    auto node = std::make_shared<CoordinatorNode>(bus, scenario, self, is_standby);
    log_events_of(*node);
    return {node, {}};
  };
  return run_process(argc, argv, program);
}
