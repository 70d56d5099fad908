// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/picture/run_timing.hpp"

#include "tests/catch.hpp"

namespace sidestep::run_timing_test {

FloorTrace from_to(double begin_s, double end_s) {
  FloorTrace trace;
  trace.robots.resize(2);
  trace.robots[0].path = {{begin_s, {0, 0}, 0}, {end_s, {1, 0}, 0}};
  return trace;
}

TEST_CASE("a picture plays in real time from the first grant on, and long runs play faster") {
  const RunTiming timing = timing_of(from_to(-4, 3));
  CHECK(timing.plays());
  CHECK(timing.begin_s == 0);
  CHECK(timing.end_s == 3);
  CHECK(timing.speed == 1);
  CHECK(timing.round_s() == Approx(4.5));
  CHECK(timing.share(-1) == 0);
  CHECK(timing.share(1.5) == Approx(1.5 / 4.5));
  const RunTiming hour = timing_of(from_to(0, 3600));
  CHECK(hour.speed == 200);
  CHECK(hour.round_s() < 31.5);
}

TEST_CASE("nothing plays if no robot was seen, or for a moment only") {
  CHECK_FALSE(timing_of(FloorTrace()).plays());
  CHECK_FALSE(timing_of(from_to(1, 1)).plays());
  // Nothing was granted: times count from the first time that a robot was seen.
  CHECK(timing_of(from_to(0, 20)).plays());
}

TEST_CASE("between two points of its path a robot moves evenly, before and after it rests") {
  const std::vector<FloorTrace::Point> path{{1, {0, 0}, 1}, {3, {2, 4}, 1}};
  CHECK(position_at(path, 0) == Vec2(0, 0));
  CHECK(position_at(path, 2) == Vec2(1, 2));
  CHECK(position_at(path, 3) == Vec2(2, 4));
  CHECK(position_at(path, 9) == Vec2(2, 4));
}

TEST_CASE("an animation has as many times as values, from the begin of a round to its end") {
  const RunTiming timing{0, 3, 1};
  CHECK(animation_attributes(timing, {0, 1.5, 3}, {"a", "b", "c"}) ==
        "values='a;b;c;c' keyTimes='0;0.33333;0.66667;1' dur='4.50s' repeatCount='indefinite'");
  CHECK(svg_motion(timing, {{0, {1, 2}}, {3, {3, 4}}}) ==
        "<animateTransform attributeName='transform' type='translate' values='1.0,2.0;3.0,4.0;3.0,4.0' "
        "keyTimes='0;0.66667;1' dur='4.50s' repeatCount='indefinite'/>\n");
}

}  // namespace sidestep::run_timing_test
