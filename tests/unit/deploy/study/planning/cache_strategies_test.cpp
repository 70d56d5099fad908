// SPDX-License-Identifier: Apache-2.0
#include "deploy/study/planning/cache_strategies.hpp"

#include <catch2/catch.hpp>

#include "tests/unit/deploy/study/study_files.hpp"

using namespace sidestep;

TEST_CASE("cache strategies are compared by their seed") {
  check_experiment([](std::uint64_t seed, const StudyAdvance& advance) {
    return cache_strategies({{0, 0.5}, 2, 20}, seed, advance);
  });
}

TEST_CASE("with each strategy replans keep fewer nodes the more way points they grow towards") {
  const auto seed = GENERATE(1u, 4u);
  CAPTURE(seed);
  const auto rows = rows_of(cache_strategies({{0, 0.2, 0.8}, 2, 150}, seed, [](auto, auto) {}));
  for (const char* strategy : {"random", "oldest", "whole plan"}) {
    CAPTURE(strategy);
    const auto nodes = [&](const char* probability) {
      return number_in(rows, {{"waypoint_probability", probability}, {"strategy", strategy}}, "median_nodes");
    };
    CHECK(nodes("0") > nodes("0.2"));
    CHECK(nodes("0.2") > nodes("0.8"));
  }
}

TEST_CASE("a cache that keeps what was used needs more nodes for the hard replans than one that forgets it") {
  const auto seed = GENERATE(1u, 4u);
  CAPTURE(seed);
  const auto rows = rows_of(cache_strategies({{0.7}, 2, 200}, seed, [](auto, auto) {}));
  for (const char* strategy : {"random", "oldest", "whole plan"}) {
    CAPTURE(strategy);
    CHECK(number_in(rows, {{"strategy", "least recently used"}}, "p95_nodes") >
          number_in(rows, {{"strategy", strategy}}, "p95_nodes"));
  }
}
