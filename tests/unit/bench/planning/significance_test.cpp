// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/planning/significance.hpp"

#include <bit>

#include "tests/catch.hpp"

namespace sidestep::significance_test {

/// Slow reference for Fisher's exact test: enumerates every choice of the trials that succeed.
double enumerated_p(std::size_t successes, std::size_t trials, std::size_t other_successes,
                    std::size_t other_trials) {
  const std::size_t total = successes + other_successes;
  const unsigned first = (1u << trials) - 1;
  double as_few = 0, all = 0;
  for (unsigned chosen = 0; chosen < (1u << (trials + other_trials)); ++chosen) {
    if (static_cast<std::size_t>(std::popcount(chosen)) != total) continue;
    ++all;
    if (static_cast<std::size_t>(std::popcount(chosen & first)) <= successes) ++as_few;
  }
  return as_few / all;
}

TEST_CASE("Fisher's exact test gives the same probability as enumeration") {
  for (std::size_t trials = 1; trials <= 6; ++trials)
    for (std::size_t other_trials = 1; other_trials <= 6; ++other_trials)
      for (std::size_t successes = 0; successes <= trials; ++successes)
        for (std::size_t other_successes = 0; other_successes <= other_trials; ++other_successes) {
          CAPTURE(successes, trials, other_successes, other_trials);
          CHECK(fewer_successes_p(successes, trials, other_successes, other_trials) ==
                Approx(enumerated_p(successes, trials, other_successes, other_trials)));
        }
}

TEST_CASE("Fisher's exact test finds a real difference in a thousand queries and no spurious difference") {
  CHECK(fewer_successes_p(1000, 1000, 1000, 1000) == Approx(1));
  CHECK(fewer_successes_p(990, 1000, 1000, 1000) < 0.01);
  CHECK(fewer_successes_p(996, 1000, 1000, 1000) > 0.01);
  CHECK(fewer_successes_p(800, 1000, 850, 1000) < 0.01);
  CHECK(fewer_successes_p(850, 1000, 800, 1000) > 0.5);
  CHECK(fewer_successes_p(0, 0, 3, 3) == Approx(1));
}

}  // namespace sidestep::significance_test
