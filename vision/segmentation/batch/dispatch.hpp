// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "vision/segmentation/batch/kernels.hpp"

namespace sidestep::segmentation {

/// The kernels that this machine can run, fastest last.
const std::vector<Kernels>& available_kernels();

const Kernels& best_kernels();

}  // namespace sidestep::segmentation
