// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/picture/shown_part.hpp"

#include "tests/catch.hpp"

namespace sidestep::shown_part_test {

double area(const Box& box) { return (box.max_m - box.min_m).prod(); }

/// Two robots that swap places.
FloorTrace swap(const Field& field, const Vec2& first_m, const Vec2& second_m) {
  FloorTrace trace;
  trace.field = field;
  trace.robots.push_back({0, Team::kBlue, first_m, {second_m}, {{0, first_m, 0}, {1, second_m, 0}}});
  trace.robots.push_back({1, Team::kBlue, second_m, {first_m}, {{0, second_m, 0}, {1, first_m, 0}}});
  return trace;
}

TEST_CASE("a picture is not half empty: it shows the part of the field that robots use") {
  // In two rows of a large field, as in two-teams-22.
  FloorTrace trace = swap({12, 9}, {-5.6, -1.3}, {5.6, 1.3});
  const Box part = shown_part(trace);
  CHECK(part.min_m.x() == -6);
  CHECK(part.max_m.x() == 6);
  CHECK(part.max_m.y() - part.min_m.y() < 5);
  CHECK(2 * 5.6 * 2 * 1.3 > 0.5 * area(part));
}

TEST_CASE("a part that is hardly smaller than the field ends at the field's edges") {
  const Box part = shown_part(swap({10, 8}, {-4, -3}, {4, 3}));
  CHECK(part.min_m == Vec2(-5, -4));
  CHECK(part.max_m == Vec2(5, 4));
}

TEST_CASE("everything that robots and opponents use is in the picture, and small obstacles are whole") {
  FloorTrace trace = swap({100, 100}, {10, 10}, {14, 12});
  trace.opponents = {{0.3, 1, {{20, 10}, {20, 14}}}};
  trace.obstacles = {Circle{{12, 15}, 1}, Box{{-50, 11}, {50, 11.1}}};
  const Box part = shown_part(trace);
  CHECK(part.min_m.x() < 10 - trace.radius_m);
  CHECK(part.max_m.x() > 20.3);
  CHECK(part.max_m.y() >= 16);
  // The long wall does not make everything else small.
  CHECK(part.max_m.x() - part.min_m.x() < 15);
}

TEST_CASE("the part has the shape of a screen, also if robots drive along a line") {
  const Box part = shown_part(swap({100, 100}, {-20, 0}, {20, 0}));
  const Vec2 size = part.max_m - part.min_m;
  CHECK(size.x() / size.y() <= Approx(2.5));
  const Box upright = shown_part(swap({100, 100}, {0, -20}, {0, 20}));
  CHECK((upright.max_m - upright.min_m).x() / (upright.max_m - upright.min_m).y() >= Approx(0.5));
  // The field limits this.
  const Box corridor = shown_part(swap({40, 2}, {-19, 0}, {19, 0}));
  CHECK(corridor.min_m == Vec2(-20, -1));
  CHECK(corridor.max_m == Vec2(20, 1));
}

TEST_CASE("robots beyond the field's edge, and floors without robots, are shown") {
  const Box part = shown_part(swap({4, 4}, {-3, 0}, {1, 0}));
  CHECK(part.min_m.x() <= -3 - 0.09);
  const Box empty = shown_part(swap({4, 3}, {0, 0}, {0, 0}));
  CHECK(area(empty) > 0);
  FloorTrace nothing;
  nothing.field = {4, 3};
  CHECK(shown_part(nothing).max_m == Vec2(2, 1.5));
}

}  // namespace sidestep::shown_part_test
