// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deploy/evaluation/study/table/study_table.hpp"

namespace sidestep {

/// A row for each planner and number of people of a table of runs: how many robots reached all their goals,
/// the time, and what went wrong. Precondition: the table has the columns of the clutter study.
[[nodiscard]] StudyTable clutter_summary(const StudyTable& runs);

/// The share of robots that reached all their goals over the number of people, a line for each planner.
[[nodiscard]] Plot success_plot(const StudyTable& summary);

}  // namespace sidestep
