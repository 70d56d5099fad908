// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/study/table/study_table.hpp"

namespace sidestep {

/// Summarises a table of runs with one row per planner and number of people: robots that reached all their
/// goals, times, contacts and crashes. Precondition: the table has the columns of the clutter study.
[[nodiscard]] StudyTable clutter_summary(const StudyTable& runs);

/// Plots the share of robots that reached all their goals against the number of people, with one line per
/// planner.
[[nodiscard]] Plot success_plot(const StudyTable& summary);

}  // namespace sidestep
