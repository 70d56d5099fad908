// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/study/table/study_table.hpp"

namespace sidestep {

/// Studies navigation functions on grids: errors of their kernels by direction and among obstacles, changes
/// when a wall appears, and effects of costs on paths. Writes directions, obstacles, replanning and costs as
/// .csv and .png into the folder, which it creates. Throws std::runtime_error with the reason of a failure.
int study_navigation(const StudyOptions& options);

}  // namespace sidestep
