// SPDX-License-Identifier: Apache-2.0
#pragma once

// Included by sources compiled for different instruction sets: no inline functions here.

namespace sidestep {

/// Speed at which a planned motion counts as at rest: such a speed is a rounding error, and has no direction.
/// Measured speeds are noisier and need a higher threshold.
inline constexpr double kPlannedRest_mps = 1e-6;

}  // namespace sidestep
