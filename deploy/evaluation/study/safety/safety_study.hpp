// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deploy/evaluation/study/study_table.hpp"

namespace sidestep {

/// The evaluation of the safety search (Bruce, ch. 5): traversals with and without it, margins against the
/// noise of vision, and the search's time. Writes traversals, margins and search as .csv and .png into the
/// folder, which it makes, and shows progress on stderr. Throws std::runtime_error saying what fails.
int study_safety(const StudyOptions& options);

}  // namespace sidestep
