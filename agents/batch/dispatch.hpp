// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "agents/batch/kernels.hpp"

namespace sidestep::batch {

/// Kernels for the instruction sets that this machine supports, in order of increasing speed.
[[nodiscard]] const std::vector<Kernels>& available_kernels();

/// The fastest available kernels.
[[nodiscard]] const Kernels& best_kernels();

}  // namespace sidestep::batch
