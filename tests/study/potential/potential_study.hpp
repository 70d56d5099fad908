// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/study/table/study_table.hpp"

namespace sidestep {

/// Compares potential fields, with and without rotation, with navigation functions: local minima in five
/// kinds of scenes, and oscillation in corridors of several widths. Writes minima and oscillation as .csv and
/// .png, and trap.svg, into the folder, which it creates, and shows progress on stderr. Throws
/// std::runtime_error with the reason of a failure.
int study_potential(const StudyOptions& options);

}  // namespace sidestep
