// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "tests/bench/crowds/crowd_result.hpp"
#include "tests/study/measurement/distribution.hpp"

namespace sidestep {

/// The result as the cells of a row, separated by commas; "-" for what is unknown.
[[nodiscard]] std::string crowd_result_cells(const CrowdResult& result);
/// The result in such cells. Throws std::invalid_argument if they are damaged.
[[nodiscard]] CrowdResult crowd_result_from(std::span<const std::string> cells);

/// How one method drove the robots of all scenes of a family.
struct CrowdScore {
  int scenes = 0, robots = 0, arrived = 0;
  std::uint64_t contacts = 0, violations = 0;
  Distribution ratio, makespan_s;  ///< of the scenes in which all robots arrived
  Distribution cpu_us;

  void add(const CrowdResult& result);
  /// Whether all robots arrived, without a contact or a violation.
  [[nodiscard]] bool is_clean() const { return arrived == robots && contacts == 0 && violations == 0; }
};

/// Whether the first score is the better one: fewer contacts and violations, then fewer robots that did not
/// arrive, then the lower mean ratio.
[[nodiscard]] bool is_better(const CrowdScore& first, const CrowdScore& second);

}  // namespace sidestep
