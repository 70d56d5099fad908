// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace sidestep {

/// The minimum distance between two labels of a horizontal axis.
inline constexpr double kTickSpacing_px = 75;

/// The smallest of 1, 2 and 5 times a power of ten that is at least `min`, which should be positive; from
/// 1e-300 to 1e307.
[[nodiscard]] double round_step(double min);

/// The multiples of the step from `from` to `to`, at most 10,000. None if these numbers are not finite.
[[nodiscard]] std::vector<double> ticks(double from, double to, double step);

/// A multiple of the step with as many decimals as the step needs.
[[nodiscard]] std::string tick_label(double value, double step);

}  // namespace sidestep
