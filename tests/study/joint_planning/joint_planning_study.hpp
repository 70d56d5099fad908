// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/study/table/study_table.hpp"

namespace sidestep {

/// Compares explicit joint planning (all robots as one, or by priority) with Dynamics Safety Search (Bruce
/// 2006, chapter 5) for 2 to 16 robots: success, planning time, makespan. Writes swap and circle as .csv and
/// .png into the folder, which it creates, and shows progress on stderr. Returns 1 if the independent check
/// finds a fault in a plan, or if robots touched. Throws std::runtime_error with the reason of a failure.
int study_joint_planning(const StudyOptions& options);

}  // namespace sidestep
