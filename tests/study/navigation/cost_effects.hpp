// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/study/table/study_table.hpp"

namespace sidestep {

/// Measures how costs affect the path of a robot that drives 8 m: a square region of 3 m with a higher cost
/// on its way, and a person who crosses its way and would meet it in the middle. Clearance is the distance
/// between the person and the robot at equal times, if the robot drives along the path at 1 m/s.
StudyTable cost_effects();

}  // namespace sidestep
