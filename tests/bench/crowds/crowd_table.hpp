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

/// Methods with which the table compares the others; for the reference see crowd_reference.hpp.
inline constexpr const char* kSidestepMethod = "sidestep";
inline constexpr const char* kReferenceMethod = "reference";

/// The table of the benchmark, a row for each family and method. Its columns `over_sidestep` and
/// `over_reference` are the relative_ratio() of a method and Sidestep or the reference in the same family.
/// An incomplete scene is worse than every complete one. If the median or the worst scene is incomplete, the
/// cell of its value says "failed". The plots of arrival and makespan show the scenes that all methods
/// completed; a method that completed none in a family has no bar there.
[[nodiscard]] StudyTable crowd_table(std::span<const CrowdRow> rows);

}  // namespace sidestep
