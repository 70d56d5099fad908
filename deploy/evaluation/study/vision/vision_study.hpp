// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deploy/evaluation/study/study_table.hpp"

namespace sidestep {

/// What vision sees in rendered frames: who is found, how far poses are off and why, and how long it takes.
/// Writes recognition, patch-errors and frame-times into the folder as study_safety() does.
int study_vision(const StudyOptions& options);

}  // namespace sidestep
