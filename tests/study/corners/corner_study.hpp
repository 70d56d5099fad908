// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/study/table/study_table.hpp"

namespace sidestep {

/// Studies one robot that sees people only with its own laser and drives around corners from behind which
/// people step out, in 10,000 random cases of five kinds. Every tenth case is repeated with cameras above the
/// floor, which shows the cost of not seeing around corners. Writes corners.csv and .png into the folder,
/// which it creates, and shows progress on stderr. Returns 1 if a robot was moving when a person and the
/// robot collided, a robot touched an obstacle, or an audit did not pass. Throws std::runtime_error with the
/// reason of a failure.
int study_corners(const StudyOptions& options);

/// Like study_corners(), but with people who stand in doorways beside a corridor and step out, in 10,000
/// random cases with maps of four resolutions. Writes doorways.csv and .png.
int study_doorways(const StudyOptions& options);

}  // namespace sidestep
