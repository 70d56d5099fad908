// SPDX-License-Identifier: Apache-2.0
#include "tests/study/planning/terrain_structures.hpp"

#include "tests/catch.hpp"
#include "tests/unit/study/study_files.hpp"

namespace sidestep::terrain_structures_test {

TEST_CASE("the experiment on terrain structures depends only on its seed") {
  check_experiment([](std::uint64_t seed, const ProgressCallback& progress) {
    return terrain_structures({{4, 8}, 100, 2, 8192}, seed, progress);
  });
}

TEST_CASE("all terrain structures agree with a search over all triangles") {
  const auto seed = GENERATE(1u, 2u);
  CAPTURE(seed);
  const auto rows = rows_of(terrain_structures({{4, 16}, 300, 1, 8192}, seed, [](auto, auto) {}));
  CHECK(rows.size() == 2 * 2 * 4);
  for (const StudyRow& row : rows) {
    CAPTURE(row.at("triangles"), row.at("structure"), row.at("query"));
    if (!row.at("structure").starts_with("FCL")) CHECK(row.at("wrong_percent") == "0.0");
    CHECK(std::stod(row.at("touch_percent")) > 10);
    CHECK(std::stod(row.at("touch_percent")) < 90);
  }
}

TEST_CASE("the linear list is not timed on large terrains") {
  const auto rows = rows_of(terrain_structures({{8, 16}, 50, 1, 200}, 1, [](auto, auto) {}));
  for (const StudyRow& row : rows) CHECK((row.at("structure") != "linear" || row.at("triangles") == "128"));
}

}  // namespace sidestep::terrain_structures_test
