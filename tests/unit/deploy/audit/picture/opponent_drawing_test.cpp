// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/picture/opponent_drawing.hpp"

#include <algorithm>

#include "tests/catch.hpp"

namespace sidestep::opponent_drawing_test {

std::vector<std::pair<double, double>> x_of(const std::vector<FloorTrace::Point>& path) {
  std::vector<std::pair<double, double>> result;
  for (const FloorTrace::Point& point : path) result.emplace_back(point.at_s, point.position_m.x());
  return result;
}

TEST_CASE("an opponent goes back and forth along its path at its speed") {
  const OpponentSpec opponent{0.2, 2, {{0, 0}, {4, 0}}};
  CHECK(x_of(opponent_path(opponent, 1, 7)) ==
        std::vector<std::pair<double, double>>{{1, 2}, {2, 4}, {4, 0}, {6, 4}, {7, 2}});
}

TEST_CASE("an opponent whose path ends where it begins goes round") {
  const OpponentSpec opponent{0.2, 1, {{0, 0}, {1, 0}, {1, 1}, {0, 0}}};
  const auto path = opponent_path(opponent, 0, 3.5);
  REQUIRE(path.size() == 5);
  CHECK(path[3].position_m == Vec2(0, 0));
  CHECK(path[3].at_s == Approx(2 + std::sqrt(2.0)));
  CHECK(path[4].position_m.x() == Approx(3.5 - 2 - std::sqrt(2.0)));
}

TEST_CASE("an opponent with one place or without speed stays") {
  for (const OpponentSpec& opponent :
       {OpponentSpec{0.2, 1, {{3, 0}}}, OpponentSpec{0.2, 0, {{3, 0}, {4, 0}}}})
    CHECK(x_of(opponent_path(opponent, 0, 9)) == std::vector<std::pair<double, double>>{{0, 3}, {9, 3}});
}

TEST_CASE("a path of an opponent that turns very often has a limited number of points") {
  CHECK(opponent_path({0.2, 1, {{0, 0}, {1e-6, 0}}}, 0, 1e5).size() < 2010);
}

TEST_CASE("a fast opponent long after its begin has a path in the order of time") {
  // Its rounds are shorter than the distance of two numbers that are this large.
  const auto path = opponent_path({0.2, 1e5, {{0, 0}, {0.001, 0}}}, 5e8, 5e8 + 10);
  CHECK(path.size() < 2010);
  CHECK(std::ranges::is_sorted(path, {}, &FloorTrace::Point::at_s));
  CHECK(path.front().at_s == 5e8);
  CHECK(path.back().at_s == 5e8 + 10);
  std::vector<Vec2> corners;
  for (int i = 0; i < 5000; ++i) corners.emplace_back(1e-7 * i, 0);
  CHECK(opponent_path({0.2, 1e5, corners}, -1e9, 1e9).size() < 2010 + 2 * corners.size());
}

}  // namespace sidestep::opponent_drawing_test
