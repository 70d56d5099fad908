// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "agents/batch/kernels.hpp"

namespace sidestep::batch {

/// The kernels that this machine can run, the fastest last.
const std::vector<Kernels>& available_kernels();

/// The fastest of them.
const Kernels& best_kernels();

}  // namespace sidestep::batch
