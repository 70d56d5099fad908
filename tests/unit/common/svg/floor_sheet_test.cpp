// SPDX-License-Identifier: Apache-2.0
#include "common/svg/floor_sheet.hpp"

#include "tests/catch.hpp"

namespace sidestep::floor_sheet_test {

TEST_CASE("a view maps metres to pixels, with y upwards on the floor and downwards in the picture") {
  const FloorView view{{{-2, -1}, {2, 1}}, 100, {10, 20}};
  CHECK(view.px(Vec2(-2, 1)) == Vec2(10, 20));
  CHECK(view.px(Vec2(2, -1)) == Vec2(410, 220));
  CHECK(view.px(0.5) == 50);
  CHECK(view.size_px() == Vec2(400, 200));
}

TEST_CASE("a sheet has a scale bar, coordinates along both edges, a heading and its legend") {
  FloorSheet sheet;
  sheet.view = sheet_view({{-2, -1}, {2, 1}});
  sheet.title = "a <hall>";
  sheet.subtitle = "no. 1";
  sheet.legend = {dot_entry("goal & end", "fill='red'")};
  const std::string svg = svg_sheet(sheet);
  CAPTURE(svg);
  CHECK_THAT(svg, ContainsSubstring(">a &lt;hall&gt;</text>") && ContainsSubstring(">no. 1</text>") &&
                      ContainsSubstring(">goal &amp; end</text>"));
  CHECK_THAT(svg, ContainsSubstring(">0.5 m</text>"));
  for (const char* label : {">-2.0</text>", ">1.5</text>", ">-1.0</text>", ">0.0</text>"})
    CHECK_THAT(svg, ContainsSubstring(label));
}

TEST_CASE("a sheet is as large as a screen, whether the floor has 2 m or 100 m") {
  for (const double side_m : {2.0, 9.0, 100.0}) {
    const Vec2 size = sheet_view({{0, 0}, {side_m, side_m}}).size_px();
    CHECK(size.x() == Approx(820));
    CHECK(size.y() == Approx(820));
  }
  CHECK(sheet_view({{0, 0}, {100, 2}}).size_px().x() == Approx(1130));
}

TEST_CASE("obstacles of all shapes are drawn, and all walls of a map as one path") {
  const FloorView view{{{0, 0}, {10, 10}}, 10, {0, 0}};
  CHECK_THAT(svg_obstacle(view, Circle{{1, 9}, 0.5}), StartsWith("<circle cx='10.0' cy='10.0' r='5.0'"));
  CHECK_THAT(svg_obstacle(view, Box{{0, 0}, {1, 1}}), StartsWith("<polygon points='0.0,100.0 10.0,100.0"));
  CHECK_THAT(svg_obstacle(view, Segment{{0, 10}, {1, 10}}), StartsWith("<polyline points='0.0,0.0 10.0,0.0"));
  CHECK_THAT(svg_obstacle(view, ConvexPolygon{{{0, 10}, {1, 9}, {1, 10}}}), StartsWith("<polygon"));
  const std::vector<Box> walls{{{0, 9}, {1, 10}}, {{2, 9}, {4, 10}}};
  CHECK_THAT(svg_obstacles(view, walls),
             StartsWith("<path d='M0.0 0.0h10.0v10.0h-10.0zM20.0 0.0h20.0v10.0h-20.0z'"));
  CHECK(svg_obstacles(view, {}).empty());
}

}  // namespace sidestep::floor_sheet_test
