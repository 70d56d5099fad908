// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/planning/replan_bench.hpp"

#include "tests/catch.hpp"

namespace sidestep::replan_bench_test {

TEST_CASE("replanned paths among moving circles are valid") {
  CHECK(bench_replanning({"lazy-visibility", "bi-errt", "rrt-connect+cache", "estar", "nf1"}, 60, 1).empty());
}

TEST_CASE("planners that need a static world are left out if obstacles move") {
  CHECK(bench_replanning({"visibility", "prm"}, 10, 1).empty());
}

}  // namespace sidestep::replan_bench_test
