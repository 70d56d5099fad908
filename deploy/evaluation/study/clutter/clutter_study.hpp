// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deploy/evaluation/study/table/study_table.hpp"

namespace sidestep {

/// Robots among obstacles and people, with every planner that drives robots: one robot among more and more
/// people in a hall, and six robots among people in random buildings. Prints a summary, writes people and
/// buildings as .csv and .png into the folder, which it creates, and shows progress on stderr. Returns 1 if
/// robots touched each other or an obstacle, crashed into a person in motion, or an audit did not pass.
/// Throws std::runtime_error that says what failed. `planners`: only these; empty: all that drive robots.
int study_clutter(const StudyOptions& options, const std::vector<std::string>& planners = {});

}  // namespace sidestep
