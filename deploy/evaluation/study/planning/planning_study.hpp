// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deploy/evaluation/study/study_table.hpp"

namespace sidestep {

/// The evaluation of planning and collision detection (Bruce, ch. 3 and 4): writes one table and picture for
/// each experiment of deploy/evaluation/study/planning into the folder, which it makes, prints the tables, and shows
/// progress on stderr. Everything is timed, so one process does it all. Throws std::runtime_error saying what
/// fails.
int study_planning(const StudyOptions& options);

}  // namespace sidestep
