// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/planning/significance.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

double log_choose(std::size_t n, std::size_t k) {
  const auto log_factorial = [](std::size_t i) { return std::lgamma(static_cast<double>(i) + 1); };
  return log_factorial(n) - log_factorial(k) - log_factorial(n - k);
}

}  // namespace

double fewer_successes_p(std::size_t successes, std::size_t trials, std::size_t other_successes,
                         std::size_t other_trials) {
  const std::size_t total = successes + other_successes;
  const std::size_t fewest = total > other_trials ? total - other_trials : 0;
  double p = 0;
  for (std::size_t k = fewest; k <= successes; ++k)
    p += std::exp(log_choose(trials, k) + log_choose(other_trials, total - k) -
                  log_choose(trials + other_trials, total));
  return std::min(p, 1.0);
}

}  // namespace sidestep
