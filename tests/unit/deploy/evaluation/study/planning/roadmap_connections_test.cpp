// SPDX-License-Identifier: Apache-2.0
#include "deploy/evaluation/study/planning/roadmap_connections.hpp"

#include <catch2/catch.hpp>

#include "tests/unit/deploy/evaluation/study/study_files.hpp"

using namespace sidestep;

namespace {

RoadmapConnections sizes(std::size_t worlds, std::size_t queries) {
  RoadmapConnections settings;
  settings.sectors = {4, 8};
  settings.neighbours = {4, 12};
  settings.radii_m = {1, 2};
  settings.moved_m = {0, 0.5};
  settings.worlds = worlds;
  settings.queries = queries;
  return settings;
}

}  // namespace

TEST_CASE("the connections of a roadmap are compared by their seed") {
  check_experiment([](std::uint64_t seed, const StudyAdvance& advance) {
    return roadmap_connections(sizes(2, 3), seed, advance);
  });
}

TEST_CASE("roadmaps with more edges solve more queries and obstacles that move take ways away") {
  const auto seed = GENERATE(1u, 20u);
  CAPTURE(seed);
  const auto rows = rows_of(roadmap_connections(sizes(4, 20), seed, [](auto, auto) {}));
  const auto of = [&](const char* connection, const char* parameter, const char* moved_m,
                      const char* column) {
    CAPTURE(connection, parameter, moved_m, column);
    return number_in(rows, {{"connection", connection}, {"parameter", parameter}, {"moved_m", moved_m}},
                     column);
  };
  struct Method {
    const char *name, *few, *many;
  };
  for (const auto& [name, few, many] :
       {Method{"sectors", "4", "8"}, Method{"nearest", "4", "12"}, Method{"within", "1 m", "2 m"}}) {
    CAPTURE(name);
    CHECK(of(name, few, "0", "edges_per_node") < of(name, many, "0", "edges_per_node"));
    CHECK(of(name, few, "0", "edges_per_node") == of(name, few, "0.5", "edges_per_node"));
    CHECK(of(name, few, "0", "solved_percent") <= of(name, many, "0", "solved_percent"));
    CHECK(of(name, many, "0", "solved_percent") > of(name, many, "0.5", "solved_percent"));
    CHECK(of(name, many, "0", "queries") == 80);
    CHECK(of(name, many, "0", "median_length") >= 1);
  }
  // The sectors' edges lead everywhere, and so fewer of them do.
  CHECK(of("sectors", "4", "0", "edges_per_node") < of("nearest", "4", "0", "edges_per_node"));
  CHECK(of("sectors", "4", "0", "solved_percent") > of("nearest", "4", "0", "solved_percent"));
}
