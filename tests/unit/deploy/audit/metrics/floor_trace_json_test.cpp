// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/metrics/floor_trace_json.hpp"

#include <nlohmann/json.hpp>

#include "common/json/json_text.hpp"
#include "tests/catch.hpp"

namespace sidestep::floor_trace_json_test {

using Json = nlohmann::ordered_json;

FloorTrace example() {
  FloorTrace trace;
  trace.field = {6, 4};
  trace.radius_m = 0.1;
  trace.speed_limit_mps = 2.5;
  trace.obstacles = {Circle{{1, 1}, 0.5}, Box{{0, 0}, {1, 2}}, Segment{{-1, 0}, {1, 0}},
                     ConvexPolygon{{{0, 0}, {1, 0}, {0, 1}}}};
  trace.walls = {Box{{-3, -2}, {3, -1.9}}};
  trace.robots.push_back(
      {3, Team::kYellow, {-1, 0}, {{1, 0}, {2, 0.5}}, {{0, {-1, 0}, 0}, {1.25, {1, 0}, 0.5}}});
  trace.robots.push_back({9, Team::kBlue, {0, 1.5}, {}, {}});
  trace.opponents = {{0.25, 0.8, {{0, 0}, {1, 1}}}};
  trace.opponents_since_s = -0.5;
  trace.incidents = {{0.75, FloorTrace::kContact, {3, 9}, {0.5, 0.25}}};
  return trace;
}

Json written() {
  Json report;
  add_floor_trace(report, example());
  return report;
}

TEST_CASE("a trace that is written to a report and read again is the same") {
  const Json report = parse_ordered_json(json_text(written()));
  const auto trace = floor_trace_of(report);
  REQUIRE(trace);
  CHECK(trace->field.length_m == 6);
  CHECK(trace->field.width_m == 4);
  CHECK(trace->obstacles.size() == 4);
  REQUIRE(trace->robots.size() == 2);
  CHECK(trace->robots[0].team == Team::kYellow);
  CHECK(trace->robots[0].goals_m == example().robots[0].goals_m);
  REQUIRE(trace->robots[0].path.size() == 2);
  CHECK(trace->robots[0].path[1].at_s == 1.25);
  CHECK(trace->robots[0].path[1].position_m == Vec2(1, 0));
  CHECK(trace->robots[0].path[1].speed_mps == 0.5);
  CHECK(trace->robots[1].path.empty());
  CHECK(trace->opponents_since_s == -0.5);
  Json again;
  add_floor_trace(again, *trace);
  CHECK(again == report);
}

TEST_CASE("a report without a floor has no trace") {
  CHECK_FALSE(floor_trace_of(Json::object()));
  CHECK_FALSE(floor_trace_of(Json{{"floor", nullptr}, {"paths", nullptr}}));
}

TEST_CASE("a damaged trace is refused with the reason") {
  const auto refused = [](const char* pointer, const char* value) {
    Json report = written();
    report[Json::json_pointer(pointer)] = parse_ordered_json(value);
    CAPTURE(pointer, value);
    CHECK_THROWS_AS(floor_trace_of(report), std::invalid_argument);
  };
  refused("/floor/length_m", "0");
  refused("/floor/length_m", "\"long\"");
  refused("/floor/width_m", "-3");
  refused("/floor/width_m", "1e300");
  refused("/floor/robot_radius_m", "null");
  refused("/floor/obstacles", "[{\"polygon\": []}]");
  refused("/floor/obstacles", "[{\"blob\": 1}]");
  refused("/floor/walls", "[[1, 2, 3]]");
  refused("/floor/robots/0/id", "\"three\"");
  refused("/floor/robots/0/id", "1e300");
  refused("/floor/robots/0/id", "-1");
  refused("/floor/robots/0/id", "9");  // the id of the other one
  refused("/floor/robots/0/start_m", "[1]");
  refused("/floor/opponents/0/path_m", "[]");
  refused("/paths/3", "[[0, 0, 0]]");
  refused("/paths/3", "[[1, 0, 0, 0], [0, 0, 0, 0]]");
  refused("/paths", "null");
  refused("/incidents", "7");
  refused("/incidents/0/robots", "[1e300]");
  Json report = written();
  const Json opponent = report["floor"]["opponents"][0];
  for (int i = 0; i < 1000; ++i) report["floor"]["opponents"].push_back(opponent);
  CHECK_THROWS_WITH(floor_trace_of(report), EndsWith("there are more than 1000 opponents"));
  report = written();
  report.erase("incidents");
  CHECK_THROWS_AS(floor_trace_of(report), std::invalid_argument);
  report = written();
  report["floor"]["length_m"] = -1;
  CHECK_THROWS_WITH(floor_trace_of(report), "the floor or the paths are damaged: -1 is not positive");
}

}  // namespace sidestep::floor_trace_json_test
