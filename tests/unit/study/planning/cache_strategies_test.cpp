// SPDX-License-Identifier: Apache-2.0
#include "tests/study/planning/cache_strategies.hpp"

#include "tests/catch.hpp"
#include "tests/unit/study/study_files.hpp"

namespace sidestep::cache_strategies_test {

TEST_CASE("the experiment on cache strategies depends only on its seed") {
  check_experiment([](std::uint64_t seed, const ProgressCallback& advance) {
    return cache_strategies({{0, 0.5}, 2, 20}, seed, advance);
  });
}

TEST_CASE("with each strategy, replans that grow towards waypoints more often keep fewer nodes") {
  const auto seed = GENERATE(1u, 4u);
  CAPTURE(seed);
  const auto rows = rows_of(cache_strategies({{0, 0.2, 0.7}, 2, 200}, seed, [](auto, auto) {}));
  for (const char* strategy : {"random", "oldest", "least recently used", "whole plan"}) {
    CAPTURE(strategy);
    const auto nodes = [&](const char* probability, const char* column) {
      return number_in(rows, {{"waypoint_probability", probability}, {"strategy", strategy}}, column);
    };
    CHECK(nodes("0", "median_nodes") > nodes("0.2", "median_nodes"));
    CHECK(nodes("0.2", "median_nodes") > nodes("0.7", "median_nodes"));
    CHECK(nodes("0", "p95_nodes") > 2 * nodes("0.7", "p95_nodes"));
  }
}

}  // namespace sidestep::cache_strategies_test
