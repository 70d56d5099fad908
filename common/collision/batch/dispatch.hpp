// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/collision/batch/kernels.hpp"

namespace sidestep::collision {

/// The kernels that this machine can run, the fastest last.
const std::vector<Kernels>& available_kernels();

/// The fastest of them.
const Kernels& best_kernels();

}  // namespace sidestep::collision
