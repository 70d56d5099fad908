// SPDX-License-Identifier: Apache-2.0
#include "common/svg/svg.hpp"

#include <array>

#include "tests/catch.hpp"

namespace sidestep::svg_test {

TEST_CASE("a path leads through its points") {
  CHECK(svg_path_data(std::array{Vec2(1, 2), Vec2(3, 4.3), Vec2(-1, 0)}) == "M1.0 2.0L3.0 4.3L-1.0 0.0");
  CHECK(svg_path_data(std::span<const Vec2>()).empty());
  CHECK(svg_points(std::array{Vec2(1, 2), Vec2(3, 4)}) == "1.0,2.0 3.0,4.0 ");
}

TEST_CASE("an arrow points in its direction, whatever the length of the direction") {
  CHECK(svg_arrow_data({10, 20}, {0, -3}, 5) == "M10.0 15.0L14.0 23.5L6.0 23.5z");
  CHECK(svg_arrow_data({10, 20}, {0, -0.1}, 5) == svg_arrow_data({10, 20}, {0, -3}, 5));
}

TEST_CASE("the estimated width of a text counts characters, not bytes") {
  CHECK(text_width_px("\xC3\xBC\xC3\xBC", 10) == text_width_px("uu", 10));
}

}  // namespace sidestep::svg_test
