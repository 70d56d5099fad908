// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/study/table/study_table.hpp"

namespace sidestep {

/// Runs `sidestep study camera`: one camera guides a robot, based on colour blobs in the image. Returns the
/// exit code: 1 if the robot touched an obstacle, a still camera was reported as moved, or a moved camera was
/// not noticed. Throws std::runtime_error if a file cannot be written.
[[nodiscard]] int study_camera(const StudyOptions& options);

}  // namespace sidestep
