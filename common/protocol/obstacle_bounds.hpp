// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sidestep {

/// The completeness radius of a message from which no obstacle was left out. It is finite, as every number in
/// a message must be.
inline constexpr double kCompleteEverywhere_m = 1e9;

/// An obstacle is within this many standard deviations of its observed position: in each axis, an error of a
/// normal distribution exceeds 4 sigma once in 16,000 cases.
inline constexpr double kObstacleSigmas = 4;

}  // namespace sidestep
