// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/collision/batch/kernels.hpp"

namespace sidestep::collision {

/// The kernels that this machine supports, fastest last.
const std::vector<Kernels>& available_kernels();

/// The fastest kernels that this machine supports.
const Kernels& best_kernels();

}  // namespace sidestep::collision
