// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/study/table/study_table.hpp"

namespace sidestep {

/// Evaluates vision on rendered frames: recognition rates, pose errors and their sources, processing time.
/// Writes recognition, marker-errors and frame-times into the folder, in the same way as study_safety().
int study_vision(const StudyOptions& options);

}  // namespace sidestep
