// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include "common/config/scenario.hpp"
#include "deploy/trial/test/plan/expectation.hpp"
#include "deploy/trial/test/plan/planned_fault.hpp"

namespace sidestep {

class YamlMap;

/// A scenario with faults and with expectations for its runs. All names and times in it are valid.
struct FaultTest {
  std::string file;
  Scenario scenario;
  std::vector<PlannedFault> faults;       ///< in the file's order
  std::vector<Expectation> expectations;  ///< at least one
};

/// Whether the test has a fault of this kind.
template <typename Action>
[[nodiscard]] bool has_fault(const FaultTest& test) {
  return std::ranges::any_of(
      test.faults, [](const PlannedFault& fault) { return std::holds_alternative<Action>(fault.action); });
}

/// Reads a scenario file with the keys `faults` and `expect` (deploy/scenarios/README.md). Throws
/// ConfigError.
[[nodiscard]] FaultTest load_fault_test(const std::string& path);
/// Parses the text of a scenario file with these keys.
[[nodiscard]] FaultTest parse_fault_test(const std::string& text, const std::string& file);

/// Records the keys `faults` and `expect` in the schema of the map.
void describe_fault_test(YamlMap& map);

}  // namespace sidestep
