// SPDX-License-Identifier: Apache-2.0
#include "tests/study/planning/bridges_and_extensions.hpp"

#include "tests/catch.hpp"
#include "tests/unit/study/study_files.hpp"

namespace sidestep::bridges_and_extensions_test {

TEST_CASE("the experiment on bridges and extensions depends only on its seed") {
  check_experiment([](std::uint64_t seed, const ProgressCallback& advance) {
    return bridges_and_extensions({{1, 8}, {1, 4}, 2, 4}, seed, advance);
  });
}

TEST_CASE("more bridges shorten paths at the cost of nodes, and more extensions lengthen paths") {
  const auto seed = GENERATE(1u, 40u);
  CAPTURE(seed);
  const auto rows = rows_of(bridges_and_extensions({{1, 32}, {1, 16}, 5, 20}, seed, [](auto, auto) {}));
  const auto of = [&](const char* extensions, const char* bridges, const char* column) {
    return number_in(rows, {{"extensions", extensions}, {"bridges", bridges}}, column);
  };
  for (const char* extensions : {"1", "32"}) {
    CAPTURE(extensions);
    CHECK(of(extensions, "16", "median_length") < of(extensions, "1", "median_length"));
    CHECK(of(extensions, "16", "median_nodes") > of(extensions, "1", "median_nodes"));
    CHECK(of(extensions, "1", "solved_percent") == 100);
    CHECK(of(extensions, "1", "queries") == 100);
  }
  for (const char* bridges : {"1", "16"})
    CHECK(of("32", bridges, "median_length") > of("1", bridges, "median_length"));
}

}  // namespace sidestep::bridges_and_extensions_test
