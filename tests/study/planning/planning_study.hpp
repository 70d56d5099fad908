// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/study/table/study_table.hpp"

namespace sidestep {

/// Evaluates planning and collision detection (Bruce 2006, chapters 3 and 4). Writes a table and a picture
/// for each experiment into the folder, which it creates, prints the tables, and shows progress on stderr.
/// Every experiment is timed, so the experiments run one after another in one process. Returns the exit code;
/// throws std::runtime_error with the reason of a failure.
int study_planning(const StudyOptions& options);

}  // namespace sidestep
