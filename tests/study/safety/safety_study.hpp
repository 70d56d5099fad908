// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/study/table/study_table.hpp"

namespace sidestep {

/// Evaluates the safety search (Bruce 2006, chapter 5): traversals with and without it, margins under vision
/// noise, and search time. Writes traversals, margins and search as .csv and .png into the folder, which it
/// creates, and shows progress on stderr. Throws std::runtime_error with the reason of a failure.
int study_safety(const StudyOptions& options);

}  // namespace sidestep
