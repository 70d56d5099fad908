// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deploy/evaluation/study/table/study_table.hpp"

namespace sidestep {

/// What costs do to the path of a robot that drives 8 m: a square region of 3 m in its way that costs more,
/// and a person who crosses its way and would meet it in the middle. Clearance: between the person and the
/// robot at the same time, if it drives along the path at 1 m/s.
StudyTable cost_effects();

}  // namespace sidestep
