// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "tests/bench/crowds/crowd_score.hpp"
#include "tests/study/table/study_table.hpp"

namespace sidestep {

/// The score of one method in one family.
struct CrowdRow {
  std::string family;
  std::string method;
  std::string setting{};  ///< of the method; empty: it has only one
  CrowdScore score;
};

/// The reference among the methods, see crowd_reference.hpp.
inline constexpr const char* kReferenceMethod = "reference";

/// The table of the benchmark, a row for each family and method. Its column `over_reference` is a method's
/// mean ratio divided by that of the reference in the same family. The plots compare the methods in all
/// families.
[[nodiscard]] StudyTable crowd_table(std::span<const CrowdRow> rows);

}  // namespace sidestep
