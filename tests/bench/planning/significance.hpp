// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace sidestep {

/// Fisher's exact test, one-sided: the probability that the first sample has at most this many successes,
/// given the total of both samples, if both have the same success rate. 1 if a sample is empty.
[[nodiscard]] double fewer_successes_p(std::size_t successes, std::size_t trials, std::size_t other_successes,
                                       std::size_t other_trials);

}  // namespace sidestep
