// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/study/table/study_table.hpp"

namespace sidestep {

/// Studies robots among obstacles and people with every planner that drives robots: one robot among an
/// increasing number of people in a hall, and six robots among people in random buildings. Prints a summary,
/// and writes the tables people and buildings as .csv and .png into the folder, which it creates. Shows
/// progress on stderr. Returns 1 if robots touched each other or an obstacle, crashed into a person in
/// motion, or an audit did not pass. Throws std::runtime_error with the reason of a failure. If `planners` is
/// not empty, only these are studied.
int study_clutter(const StudyOptions& options, const std::vector<std::string>& planners = {});

}  // namespace sidestep
