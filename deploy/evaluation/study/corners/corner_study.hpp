// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deploy/evaluation/study/table/study_table.hpp"

namespace sidestep {

/// One robot that sees people only by its own laser drives around corners from behind which people step out:
/// 10,000 random cases of five kinds. Every tenth is repeated with cameras above the floor, which shows what
/// not seeing around corners costs. Writes corners.csv and .png into the folder, which it creates, and shows
/// progress on stderr. Returns 1 if a robot moved when somebody walked into it, touched an obstacle, or an
/// audit did not pass. Throws std::runtime_error that says what failed.
int study_corners(const StudyOptions& options);

/// As study_corners(), with people who stand in doorways beside a corridor and step out: 10,000 random cases
/// with maps of four resolutions. Writes doorways.csv and .png.
int study_doorways(const StudyOptions& options);

}  // namespace sidestep
