// SPDX-License-Identifier: Apache-2.0
#include "tests/study/planning/cache_replans.hpp"

#include "tests/catch.hpp"
#include "tests/unit/study/study_files.hpp"

namespace sidestep::cache_replans_test {

TEST_CASE("the experiment on caches depends only on its seed") {
  check_experiment([](std::uint64_t seed, const ProgressCallback& advance) {
    return cache_replans({.replans = 40}, seed, advance);
  });
}

TEST_CASE("with a cache, replans keep fewer nodes and paths are shorter") {
  const auto seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  const auto rows = rows_of(cache_replans({.replans = 800}, seed, [](auto, auto) {}));
  for (const std::string planner : {"one tree", "two trees"}) {
    CAPTURE(planner);
    for (const char* column : {"median_nodes", "p95_nodes", "median_length"}) {
      CAPTURE(column);
      CHECK(number_in(rows, {{"planner", planner + " with cache"}}, column) <
            number_in(rows, {{"planner", planner}}, column));
    }
    for (const std::string& name : {planner, planner + " with cache"}) {
      CHECK(number_in(rows, {{"planner", name}}, "queries") == 800);
      CHECK(number_in(rows, {{"planner", name}}, "solved_percent") > 98);
      CHECK(number_in(rows, {{"planner", name}}, "median_length") >= 1);
    }
  }
}

}  // namespace sidestep::cache_replans_test
