// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

#include "common/protocol/process_names.hpp"
#include "deploy/trial/test/judgement/run_history.hpp"
#include "deploy/trial/test/plan/planned_fault.hpp"

namespace sidestep {

/// Resolves a process name: kActiveCoordinator becomes the name of the coordinator that grants; other names
/// are unchanged. Throws std::runtime_error if no coordinator has granted.
[[nodiscard]] inline std::string resolved(const std::string& process, const RunHistory& history) {
  if (process != kActiveCoordinator) return process;
  const auto number = history.granting_coordinator();
  if (!number) throw std::runtime_error("no coordinator has granted");
  return coordinator_process(*number);
}

}  // namespace sidestep
