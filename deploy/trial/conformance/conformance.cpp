// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/conformance/conformance.hpp"

namespace sidestep {

Conformance::Conformance(Bus& bus, const Scenario& scenario, RobotId robot, Incarnation incarnation)
    : bus_(bus),
      scenario_(scenario),
      probe_(bus, scenario_, robot, incarnation),
      stream_(probe_, scenario_),
      context_{scenario_, probe_, stream_, report_},
      steps_(conformance_steps(scenario_)) {
  bus.at(bus.now(), [this] { cycle(); });
}

void Conformance::cycle() {
  if (is_finished()) return;
  const std::size_t rows = report_.rows.size();
  if (steps_[step_]->update(context_)) {
    const bool has_failed =
        report_.rows.size() > rows && report_.rows.back().conformity != Conformity::kPassed;
    const bool is_last = steps_[step_]->is_required() && has_failed;
    step_ = is_last ? steps_.size() : step_ + 1;
    probe_.reset_gap();
  }
  probe_.send_command();
  bus_.at(bus_.now() + scenario_.cycle, [this] { cycle(); });
}

}  // namespace sidestep
