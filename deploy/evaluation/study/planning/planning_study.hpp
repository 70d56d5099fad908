// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deploy/evaluation/study/table/study_table.hpp"

namespace sidestep {

/// The evaluation of planning and collision detection (Bruce 2006, chapters 3 and 4). Writes a table and a
/// picture for each experiment into the folder, which it makes, prints the tables, and shows progress on
/// stderr. Everything is timed, so all of it runs in one process. Returns the exit code; throws
/// std::runtime_error that says what failed.
int study_planning(const StudyOptions& options);

}  // namespace sidestep
