// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>

#include "tests/bench/crowds/crowd_result.hpp"
#include "tests/study/measurement/distribution.hpp"

namespace sidestep {

/// The result as the cells of a row, separated by commas; "-" for what is unknown.
[[nodiscard]] std::string crowd_result_cells(const CrowdResult& result);
/// The result in such cells. Throws std::invalid_argument if they are damaged.
[[nodiscard]] CrowdResult crowd_result_from(std::span<const std::string> cells);

/// How one method drove the robots of the scenes of a family.
struct CrowdScore {
  int scenes = 0, robots = 0, arrived = 0;
  std::uint64_t contacts = 0, violations = 0;
  std::map<std::uint64_t, CrowdResult> complete;  ///< scenes in which all robots arrived, by their seeds
  Distribution cpu_us;

  /// Precondition: each seed is added once.
  void add(std::uint64_t seed, const CrowdResult& result);
  /// The number of scenes in which a robot did not arrive.
  [[nodiscard]] int incomplete() const { return scenes - static_cast<int>(complete.size()); }
  /// Whether all robots arrived, without a contact or a violation.
  [[nodiscard]] bool is_clean() const { return arrived == robots && contacts == 0 && violations == 0; }
  /// The ratios and makespans of the complete scenes. They leave out the hardest scenes if some are
  /// incomplete, so they do not compare methods.
  [[nodiscard]] Distribution ratios() const;
  [[nodiscard]] Distribution makespans_s() const;
};

/// The mean ratio of the first score over that of the second, both of the scenes that both completed; nullopt
/// if there is no such scene.
[[nodiscard]] std::optional<double> relative_ratio(const CrowdScore& first, const CrowdScore& second);

/// Whether the first score is the better one: fewer contacts and violations, then fewer robots that did not
/// arrive, then fewer incomplete scenes, then the lower mean ratio of the scenes that both completed.
[[nodiscard]] bool is_better(const CrowdScore& first, const CrowdScore& second);

}  // namespace sidestep
