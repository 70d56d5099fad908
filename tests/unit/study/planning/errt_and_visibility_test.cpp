// SPDX-License-Identifier: Apache-2.0
#include "tests/study/planning/errt_and_visibility.hpp"

#include "tests/catch.hpp"
#include "tests/unit/study/study_files.hpp"

namespace sidestep::errt_and_visibility_test {

TEST_CASE("the experiment on trees and visibility graphs depends only on its seed") {
  check_experiment([](std::uint64_t seed, const ProgressCallback& advance) {
    return errt_and_visibility({{4, 32}, 2, 4}, seed, advance);
  });
}

TEST_CASE("visibility graphs find the shortest paths and trees longer ones") {
  const auto seed = GENERATE(1u, 11u);
  CAPTURE(seed);
  const auto rows = rows_of(errt_and_visibility({{16, 64}, 2, 25}, seed, [](auto, auto) {}));
  for (const std::string obstacles : {"16", "64"}) {
    const auto of = [&](const std::string& planner, const std::string& column) {
      CAPTURE(obstacles, planner, column);
      return number_in(rows, {{"obstacles", obstacles}, {"planner", planner}}, column);
    };
    CHECK(of("graph kept", "p95_length") == 1);
    CHECK(of("graph built anew", "p95_length") == 1);
    CHECK(of("lazy graph", "p95_length") < 1.01);
    CHECK(of("lazy graph", "solved_percent") == 100);
    CHECK(of("lazy graph", "median_nodes") < of("graph kept", "median_nodes"));
    for (const std::string trees : {"one tree", "two trees"}) {
      CHECK(of(trees, "queries") == 50);
      CHECK(of(trees, "median_length") > of(trees + " smoothed", "median_length"));
      CHECK(of(trees + " smoothed", "median_length") >= 1);
    }
  }
}

}  // namespace sidestep::errt_and_visibility_test
