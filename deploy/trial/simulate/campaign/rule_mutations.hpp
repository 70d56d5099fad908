// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/config/scenario.hpp"

namespace sidestep {

/// A change of a scenario that gives a process rules that differ from those of the others (PROTOCOL.md, "The
/// same rules").
struct RuleMutation {
  std::string key;
  std::function<void(Scenario&)> change;
  bool changes_roster = false;
};

/// One change for every rule.
[[nodiscard]] const std::vector<RuleMutation>& rule_mutations();

}  // namespace sidestep
