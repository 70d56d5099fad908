// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/navigation/iso_lines.hpp"

#include "tests/catch.hpp"
#include "tests/unit/agents/planning/grids/navigation/random_grid.hpp"

namespace sidestep::iso_lines_test {

TEST_CASE("iso-lines on a free floor are circles around the goal") {
  const CostGrid grid({.columns = 60, .rows = 50, .resolution_m = 0.1, .origin_m = {-2, 1}});
  const Vec2 goal = grid.layout().centre_of(grid.layout().cell(22, 31));
  const EStar field = propagated(grid, goal, {.kernel = GridKernel::kLineOfSight});
  const std::vector<Segment> lines = iso_lines(field, 5);
  REQUIRE(lines.size() > 500);
  for (const Segment& line : lines) {
    for (const Vec2& end : {line.from_m, line.to_m}) {
      const double level = (end - goal).norm() / grid.layout().resolution_m;
      CHECK(level == Approx(5 * std::round(level / 5)).margin(0.06));
    }
  }
  CHECK_THROWS_AS(iso_lines(field, 0), std::invalid_argument);
}

TEST_CASE("iso-lines omit blocked and unreached cells") {
  CostGrid grid({.columns = 20, .rows = 10});
  for (std::uint32_t row = 0; row < 10; ++row) grid.block(grid.layout().cell(10, row));
  const double wall_m = 10 * grid.layout().resolution_m;
  for (const Segment& line : iso_lines(propagated(grid, {0.35, 0.35}), 1))
    CHECK(std::max(line.from_m.x(), line.to_m.x()) < wall_m);
}

}  // namespace sidestep::iso_lines_test
