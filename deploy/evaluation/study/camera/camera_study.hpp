// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deploy/evaluation/study/table/study_table.hpp"

namespace sidestep {

/// `sidestep study camera`: a robot that one camera guides by blobs of its image. Returns the exit code: 1 if
/// the robot touched an obstacle, or the camera was taken for moved when it was not, or the reverse. Throws
/// std::runtime_error if a file cannot be written.
[[nodiscard]] int study_camera(const StudyOptions& options);

}  // namespace sidestep
