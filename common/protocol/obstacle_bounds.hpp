// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sidestep {

/// The completeness radius of a message that omits no obstacle. It is finite, because every number in a
/// message must be.
inline constexpr double kCompleteEverywhere_m = 1e9;

/// An obstacle is assumed to be within this number of standard deviations of its observed position: on each
/// axis, a normally distributed error exceeds 4 sigma once in 16,000 cases.
inline constexpr double kObstacleSigmas = 4;

}  // namespace sidestep
