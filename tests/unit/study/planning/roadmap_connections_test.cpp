// SPDX-License-Identifier: Apache-2.0
#include "tests/study/planning/roadmap_connections.hpp"

#include "tests/catch.hpp"
#include "tests/unit/study/study_files.hpp"

namespace sidestep::roadmap_connections_test {

RoadmapConnections sizes(std::size_t worlds, std::size_t queries) {
  RoadmapConnections settings;
  settings.sectors = {4, 8};
  settings.neighbours = {4, 12};
  settings.radii_m = {1, 2};
  settings.displacements_m = {0, 0.5};
  settings.worlds = worlds;
  settings.queries = queries;
  return settings;
}

TEST_CASE("the experiment on roadmap connections depends only on its seed") {
  check_experiment([](std::uint64_t seed, const ProgressCallback& advance) {
    return roadmap_connections(sizes(2, 3), seed, advance);
  });
}

TEST_CASE("roadmaps with more edges solve more queries, and roadmaps solve fewer after obstacles move") {
  const auto seed = GENERATE(1u, 20u);
  CAPTURE(seed);
  const auto rows = rows_of(roadmap_connections(sizes(4, 20), seed, [](auto, auto) {}));
  const auto of = [&](const char* connection, const char* parameter, const char* displacement_m,
                      const char* column) {
    CAPTURE(connection, parameter, displacement_m, column);
    return number_in(
        rows, {{"connection", connection}, {"parameter", parameter}, {"displacement_m", displacement_m}},
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
  // Roadmaps with edges in all directions solve more queries with fewer edges.
  CHECK(of("sectors", "4", "0", "edges_per_node") < of("nearest", "4", "0", "edges_per_node"));
  CHECK(of("sectors", "4", "0", "solved_percent") > of("nearest", "4", "0", "solved_percent"));
}

}  // namespace sidestep::roadmap_connections_test
