// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace sidestep {

/// Fisher's exact test, one-sided: the probability that the first of two equally successful samples has as
/// few successes as it has, or fewer, given the total of both. 1 where a sample is empty.
[[nodiscard]] double fewer_successes_p(std::size_t successes, std::size_t trials,
                                       std::size_t other_successes, std::size_t other_trials);

}  // namespace sidestep
