// SPDX-License-Identifier: Apache-2.0
// Every error in a scenario is reported with its line.
#include <cstdlib>
#include <fmt/format.h>
#include <sstream>

#include "common/config/scenario_loader.hpp"
#include "common/random/rng.hpp"
#include "tests/text_of.hpp"
#include "tests/unit/common/config/scenario_errors.hpp"
#include "tests/unit/common/map/map_folder.hpp"

namespace sidestep::scenario_error_test {

const std::string kScenarios = SIDESTEP_SOURCE_DIR "/deploy/scenarios/";

TEST_CASE("a margin below the safety budget is rejected with the required margin") {
  // The default margin is exactly sufficient: 2 x 3 mm + 2 x 0.5 ms x 2 x 2 m/s.
  CHECK(budget_of(Scenario{}).required_margin_m() == Approx(0.014).epsilon(1e-12));
  CHECK(error_of(kRobot + "margin_m: 0.014\n") == "accepted");
  check_rejected(kRobot + "margin_m: 0.0139\n", 2, "expected at least 0.014 m");
  check_rejected(kRobot + "\nlimits: {speed_mps: 3}\n", 3,
                 "margin_m: 0.014 m is less than the safety budget");
  check_rejected(kRobot + "limits: {speed_mps: 3}\nmargin_m: 0.015\n", 3, "expected at least 0.016 m");
  CHECK(error_of(kRobot + "limits: {speed_mps: 3}\nmargin_m: 0.016\n") == "accepted");
  check_rejected(kRobot + "tracking_bound_m: 0.006\n", 2, "expected at least 0.016 m");
  check_rejected(kRobot + "limits:\n  deceleration_mps2: 4\n  speed_mps: 3\n", 4,
                 "expected at least 0.016 m");
  check_rejected(kRobot + "tracking_bound_m: 0.005\nclock_bound_s: 0.002\n", 3, "expected at least 0.026 m");
  check_rejected(kRobot + "clock_bound_s: 0.002\nmargin_m: 0.025\n", 3, "expected at least 0.026 m");
  CHECK(error_of(kRobot + "clock_bound_s: 0\nmargin_m: 0.01\n") == "accepted");
  check_rejected(kRobot + "tracking_bound_m: 0\n", 2, "tracking_bound_m: expected 0.0005 to 1");
  check_rejected(kRobot + "clock_bound_s: .nan\n", 2, "clock_bound_s: expected");
}

TEST_CASE("an invalid laser is rejected with its line") {
  CHECK(error_of(kRobot + "laser: {}\n") == "accepted");
  check_rejected(kRobot + "laser: {beams: 7}\n", 2, "laser.beams: expected 8 to 2048");
  check_rejected(kRobot + "laser: {beams: 2049}\n", 2, "laser.beams: expected 8 to 2048");
  check_rejected(kRobot + "laser: {field_of_view_rad: 7}\n", 2, "laser.field_of_view_rad: expected");
  check_rejected(kRobot + "laser: {max_range_m: .nan}\n", 2, "laser.max_range_m: expected");
  check_rejected(kRobot + "laser: {colour: red}\n", 2, "colour");
  const std::string person = "opponents: [{radius_m: 0.1, speed_mps: 1, path_m: [[2, 2]]}]\n";
  check_rejected(
      kRobot + person + "laser: {}\n", 3,
      "person_radius_m: expected at most the radius of every opponent, but opponents[0] has 0.1 m");
  CHECK(error_of(kRobot + person + "laser: {person_radius_m: 0.1}\n") == "accepted");
}

TEST_CASE("invalid opponents are rejected with their line") {
  const auto opponent = [](const std::string& keys) { return kRobot + "opponents:\n- {" + keys + "}\n"; };
  CHECK(error_of(opponent("radius_m: 0.1, speed_mps: 1.5, path_m: [[2, 2]]")) == "accepted");
  check_rejected(opponent("speed_mps: 1, path_m: [[2, 2]]"), 3, "key \"radius_m\" is missing");
  check_rejected(opponent("radius_m: 0.1, path_m: [[2, 2]]"), 3, "key \"speed_mps\" is missing");
  check_rejected(opponent("radius_m: 0.1, speed_mps: 1"), 3, "key \"path_m\" is missing");
  check_rejected(opponent("radius_m: 0.1, speed_mps: 1, path_m: []"), 3, "expected at least one point");
  check_rejected(opponent("radius_m: 0.1, speed_mps: 1, path_m: [[2, 2, 2]]"), 3,
                 "a list of 2 numbers, got 3");
  check_rejected(opponent("radius_m: 0.1, speed_mps: 1, path_m: [[2, .nan]]"), 3, "expected");
  check_rejected(opponent("radius_m: 0, speed_mps: 1, path_m: [[2, 2]]"), 3, "radius_m: expected 0.01 to 5");
  check_rejected(opponent("radius_m: 0.1, speed_mps: 0, path_m: [[2, 2]]"), 3,
                 "speed_mps: expected 0.01 to 20");
  check_rejected(opponent("radius_m: 0.1, speed_mps: 1.6, path_m: [[2, 2]]"), 3,
                 "opponents[0].speed_mps: expected at most max_opponent_speed_mps, 1.5, got 1.6");
  CHECK(error_of("max_opponent_speed_mps: 1.6\n" +
                 opponent("radius_m: 0.1, speed_mps: 1.6, path_m: [[2, 2]]")) == "accepted");
  check_rejected(opponent("radius_m: 0.1, speed_mps: 1, path_m: [[0.1, 0.16]]"), 1,
                 "overlaps the first point of an opponent");
  std::string many = kRobot + "opponents:\n";
  for (int i = 0; i < 1001; ++i) many += "- {radius_m: 0.1, speed_mps: 1, path_m: [[2, 2]]}\n";
  check_rejected(many, 3, "expected at most 1000 elements, got 1001");
}

TEST_CASE("invalid image settings are rejected with their line") {
  const auto images = [](const std::string& keys) { return kRobot + "vision:\n  images: {" + keys + "}\n"; };
  CHECK(error_of(images("")) == "accepted");
  CHECK(error_of(images("format: rgb, width_px: 2448, height_px: 2048")) == "accepted");
  CHECK(error_of(images("format: rgb, width_px: 781")) == "accepted");
  check_rejected(images("format: bayer"), 3,
                 "vision.images.format: expected one of yuv422, rgb, got \"bayer\"");
  check_rejected(images("width_px: 15"), 3, "vision.images.width_px: expected 16 to 4096");
  check_rejected(images("width_px: 781"), 3, "expected an even number");
  check_rejected(images("width_px: 4096, height_px: 4096"), 3, "33554432 bytes, expected at most 16777216");
  check_rejected(images("camera_height_m: 0"), 3, "camera_height_m: expected 1 to 100");
  check_rejected(images("distortion: .nan"), 3, "distortion: expected a number from 0 to 2");
  check_rejected(images("colour: red"), 3, "unknown key");
  const std::string twins =
      "robots:\n- {id: 1, start_m: [0, 0], goals_m: [[1, 0]]}\n- {id: 17, start_m: [0, 1], goals_m: [[1, "
      "1]]}\n";
  CHECK(error_of(twins) == "accepted");
  check_rejected(twins + "vision: {images: {}}\n", 4, "robots 1 and 17 both have number 1");
}

TEST_CASE("a robot that starts absent may share its start with another robot") {
  const auto pair = [](const std::string& keys) {
    return "robots:\n- {id: 0, start_m: [0, 0], goals_m: [[1, 0]]}\n- {id: 1, start_m: [0, 0.1], goals_m: "
           "[[2, "
           "0]]" +
           keys + "}\n";
  };
  check_rejected(pair(""), 3, "starts of robots 0 and 1 overlap");
  check_rejected(pair(", absent: false"), 3, "starts of robots 0 and 1 overlap");
  CHECK(error_of(pair(", absent: true")) == "accepted");
  check_rejected(pair(", absent: 1"), 3, "absent: expected true or false, got \"1\"");
  check_rejected(pair(", absent: \"true\""), 3, "expected true or false");
  check_rejected(pair(", absent: true, clock_offset_ms: 60001"), 3,
                 "clock_offset_ms: expected -60000 to 60000");
}

TEST_CASE("unknown and duplicate keys are rejected with their line") {
  check_rejected(kRobot + "margin: 0.1\n", 2, "unknown key \"margin\", expected one of: ");
  check_rejected(kRobot + "margin: 0.1\n", 2, "; did you mean margin_m?");
  check_rejected(kRobot + "vision:\n  rate_hz: 60\n  dely_ms: 3\n", 4, "unknown key \"dely_ms\"");
  check_rejected(kRobot + "vision:\n  league_interfaces: eth0\n", 3, "loopback");
  check_rejected("robots:\n  - id: 0\n    start_m: [0, 0]\n    goals_m: [[1, 0]]\n    colour: red\n", 5,
                 "unknown key \"colour\"");
  check_rejected(kRobot + "obstacles:\n  - {centre_m: [2, 2], radius_m: 0.1, hight_m: 3}\n", 3,
                 "unknown key");
  check_rejected(kRobot + "circle:\n  count: 4\n  spacing_m: 1\n  radius_m: 3\n", 5,
                 "unknown key \"radius_m\"");
  check_rejected(kRobot + "margin_m: 0.1\nradius_m: 0.1\nmargin_m: 0.1\n", 4, "duplicate key \"margin_m\"");
  check_rejected(kRobot + "vision:\n  miss_probability: 0\n  miss_probability: 0\n", 4, "duplicate key");
}

TEST_CASE("values of the wrong type are rejected with their line") {
  check_rejected(kRobot + "margin_m: wide\n", 2, "expected a number from 0 to 1, got \"wide\"");
  for (const std::string number : {"++0.1", "+-0.1", "+", "+inf", "\"+0.1\"", "+ 0.1"})
    check_rejected(kRobot + "margin_m: " + number + "\n", 2, "expected a number from 0 to 1, got");
  check_rejected(kRobot + "margin_m: \"0.1\"\n", 2, "expected a number");
  check_rejected(kRobot + "margin_m: 0.1m\n", 2, "expected a number");
  check_rejected(kRobot + "margin_m:\n", 2, "expected a number");
  check_rejected(kRobot + "margin_m: [0.1]\n", 2, "got a list");
  check_rejected(kRobot + "vision: 3\n", 2, "expected a mapping");
  check_rejected(kRobot + "vision:\n  columns: 2.5\n", 3, "expected a whole number");
  check_rejected(kRobot + "obstacles: {centre_m: [0, 0]}\n", 2, "expected a list");
  check_rejected(kRobot + "obstacles:\n- 3\n", 3, "expected a mapping");
  check_rejected(kRobot + "restart:\n- agents\n- everything\n", 4,
                 "restart: expected one of agents, coordinator, vision, robots, got \"everything\"");
  check_rejected(kRobot + "ball: {position_m: [1]}\n", 2, "expected a list of 2 numbers, got 1");
  check_rejected("robots:\n- {id: 0, team: red, start_m: [0, 0], goals_m: [[1, 0]]}\n", 2,
                 "robots[0].team: expected one of blue, yellow, got \"red\"");
  check_rejected("robots:\n- {id: 0, start_m: [0, 0], goals_m: [1, 0]}\n", 2,
                 "robots[0].goals_m: expected a list of points, e.g. [[3, 1]], got \"1\"");
  check_rejected("robots:\n- {id: 0, start_m: [0, 0], goals_m: [[1, 0], 2]}\n", 2,
                 "expected a list of 2 to 3 numbers, got \"2\"");
  check_rejected("robots:\n- id: 0\n  start_m: [0, 0]\n  goals_m:\n  - [1, 0]\n  - [1, 0, 0, 0]\n", 6,
                 "got 4");
  check_rejected("robots: 4\n", 1, "expected a list");
  check_rejected("? [a, b]\n: 3\n", 1, "expected a key");
  check_rejected("- 1\n- 2\n", 1, "expected a mapping");
  check_rejected(kRobot + "name: [a]\n", 2, "expected text");
  check_rejected(kRobot + "map: \"hall.yaml\\0.png\"\n", 2, "expected text without zero bytes");
  check_rejected(kRobot + "name: ../../x\n", 2, "letters, digits");
}

TEST_CASE("numbers that are out of range, infinite or NaN are rejected with their line") {
  for (const char* bad : {".nan", "nan", ".inf", "-.inf", "inf", "-0.001", "1.001", "1e400", "--1"}) {
    check_rejected(kRobot + "\nmargin_m: " + bad + "\n", 3, "margin_m: expected");
  }
  check_rejected(kRobot + "network: {delay_min_ms: 5,\n delay_max_ms: 4}\n", 3,
                 "expected at least delay_min_ms");
  check_rejected(kRobot + "coordinators: 0\n", 2, "expected 1 to 8, got 0");
  check_rejected(kRobot + "coordinators: 9\n", 2, "expected 1 to 8, got 9");
  check_rejected(kRobot + "planner: dijkstra\n", 2, "expected one of lazy-visibility, errt");
  check_rejected(kRobot + "planner: prm\n", 2, "got \"prm\"");
  check_rejected(kRobot + "planner: [errt]\n", 2, "expected text");
  check_rejected(kRobot + "ball: {position_m: [5, 0]}\n", 2,
                 "ball.position_m: expected a position on the field");
  check_rejected("robots:\n- id: 1024\n  start_m: [0, 0]\n  goals_m: [[1, 0]]\n", 2,
                 "expected 0 to 1023, got 1024");
  check_rejected("robots:\n- {id: -1, start_m: [0, 0], goals_m: [[1, 0]]}\n", 2,
                 "expected 0 to 1023, got -1");
  check_rejected("robots:\n- {id: 1, start_m: [0, 0], goals_m: [[1, 0, 9]]}\n", 2,
                 "9 degrees are 0.1571 radians");
  check_rejected(
      "robots:\n- {id: 1, start_m: [0, 0], heading_rad: -180}\n", 2,
      "heading_rad: expected a heading of -6.28 to 6.28 radians, got -180; -180 degrees are -3.142");
  check_rejected("robots:\n- {id: 1, start_m: [0, 0], heading_rad: inf}\n", 2,
                 "expected a heading of -6.28 to 6.28 radians, got inf");
  check_rejected("robots:\n- {id: 1, start_m: [0, 0], heading_rad: east}\n", 2,
                 "expected a heading in radians, got \"east\"");
  check_rejected(kRobot + "margin_m: \"0.1\"\n", 2, "expected a number from 0 to 1, got \"0.1\" in quotes");
}

TEST_CASE("missing robots, ids, starts and goals are rejected") {
  check_rejected("field: {length_m: 4}\n", 1, "no robots");
  check_rejected("robots: []\n", 1, "no robots");
  check_rejected("robots:\n- {start_m: [0, 0], goals_m: [[1, 0]]}\n", 2, "key \"id\" is missing");
  check_rejected("robots:\n- {id: 1, goals_m: [[1, 0]]}\n", 2, "key \"start_m\" is missing");
  check_rejected("robots:\n- {id: 1, start_m: [0, 0],\n   goals_m: []}\n", 3, "at least one goal");
  check_rejected(kRobot + "obstacles:\n- {centre_m: [2, 2]}\n", 3, "key \"radius_m\" is missing");
}

TEST_CASE("the second of two robots with the same id is rejected") {
  check_rejected(
      "robots:\n"
      "- {id: 4, start_m: [0, 0], goals_m: [[1, 0]]}\n"
      "- {id: 2, start_m: [0, 1], goals_m: [[1, 1]]}\n"
      "- {id: 4, start_m: [0, 2], goals_m: [[1, 2]]}\n",
      4, "robot id 4 is used twice");
  check_rejected("circle: {count: 5, spacing_m: 0.5}\n" + kRobot, 1, "used twice");
}

TEST_CASE("a scenario with more robots than ids is rejected") {
  check_rejected("field: {length_m: 900, width_m: 900}\ncircle:\n  count: 1025\n  spacing_m: 0.4\n", 3,
                 "expected 2 to 1024");
  check_rejected(
      "field: {length_m: 900, width_m: 900}\ncircle: {first_id: 1000,\n  count: 25, spacing_m: 0.4}\n", 3,
      "more robots than ids: expected at most 24 from id 1000 on, got 25");
  std::string many = "field: {length_m: 900, width_m: 900}\nrobots:\n";
  for (int i = 0; i < 1025; ++i) many += "- {id: 0, start_m: [0, 0], goals_m: [[0, 0]]}\n";
  check_rejected(many, 3, "more robots than ids");
}

TEST_CASE("overlapping starts and final goals are rejected, but the exact minimum distance is accepted") {
  const auto pair = [](double apart, double goals_apart) {
    std::ostringstream text;
    text
        << "radius_m: 0.09\nmargin_m: 0.014\nrobots:\n- {id: 0, start_m: [0, 0], goals_m: [[0, 0], [1, 1]]}\n"
        << "- {id: 1, start_m: [" << apart << ", 0],\n   goals_m: [[1, 1],\n     [" << 1 + goals_apart
        << ", 1]]}\n";
    return text.str();
  };
  check_rejected(pair(0.193, 0.5), 5,
                 "starts of robots 0 and 1 overlap: distance 0.1930 m, expected at least 0.1940");
  check_rejected(pair(0.5, 0.193), 7, "last goals of robots 0 and 1 overlap");
  CHECK(error_of(pair(0.194, 0.194)) == "accepted");
}

TEST_CASE("a last goal at the start of a robot without goals is rejected, and both lines are named") {
  const std::string driving = "- {id: 4, start_m: [1, 1], goals_m: [[0, 0.1]]}\n",
                    staying = "- {id: 5, start_m: [0, 0]";
  const std::string why =
      "the last goal of robot 4 (line {}) overlaps the start of robot 5 (line {}), which "
      "has no goals and stays there: distance 0.1000 m";
  check_rejected("robots:\n" + driving + staying + "}\n", 3, fmt::format(fmt::runtime(why), 2, 3));
  check_rejected("robots:\n" + staying + "}\n" + driving, 2, fmt::format(fmt::runtime(why), 3, 2));
  check_rejected("robots:\n- {id: 3, start_m: [0, 0]}\n" + driving, 3,
                 "the last goal of robot 4 (line 3) overlaps the start of robot 3 (line 2)");
  CHECK(error_of("robots:\n" + driving + staying + ", absent: true}\n") == "accepted");
}

TEST_CASE("starts and goals in blocked cells and unreadable maps are rejected") {
  const test::MapFolder folder;
  MapGrid grid;
  grid.columns = grid.rows = 40, grid.resolution_m = 0.1, grid.origin_m = {-2, -2};
  BitGrid blocked(grid.columns, grid.rows);
  for (int row = 0; row < grid.rows; ++row) blocked.set(30, row);  // x from 1 m to 1.1 m
  write_occupancy_map({grid, blocked}, folder / "hall");
  const auto error = [&](const std::string& map, const char* start, const char* goal) -> std::string {
    try {
      (void)parse_scenario(
          "map: " + map + "\nrobots:\n- id: 0\n  start_m: " + start + "\n  goals_m: [" + goal + "]\n",
          folder / "scenario.yaml");
    } catch (const ConfigError& caught) {
      return caught.what();
    }
    return "accepted";
  };
  CHECK(error("hall.yaml", "[0, 0]", "[0.896, 0]") == "accepted");
  CHECK(error(folder / "hall.yaml", "[0, 0]", "[0.896, 0]") == "accepted");
  CHECK_THAT(
      error("hall.yaml", "[0.897, 0]", "[0, 0]"),
      ContainsSubstring("scenario.yaml:4: start of robot 0 (0.897, 0) is in blocked cells of the map"));
  CHECK_THAT(error("hall.yaml", "[0, 0]", "[3, 0]"),
             ContainsSubstring("scenario.yaml:5: goal of robot 0 (3, 0)"));
  CHECK_THAT(error("none.yaml", "[0, 0]", "[1, 0]"),
             ContainsSubstring("scenario.yaml:1: map: ") && ContainsSubstring("none.yaml"));
  CHECK_THAT(error("hall.pgm", "[0, 0]", "[1, 0]"), ContainsSubstring("scenario.yaml:1: map: "));
  CHECK_THAT(error("\"\"", "[0, 0]", "[1, 0]"), ContainsSubstring("expected the path of a map's YAML file"));
  CHECK_THAT(error("[1, 2]", "[0, 0]", "[1, 0]"), ContainsSubstring("scenario.yaml:1: map: "));
}

TEST_CASE("unknown map cells are free only if the scenario allows it, and a notice then reports them") {
  const test::MapFolder folder;
  // 4 x 4 m of 0.1 m cells: free for x < 0, unknown from x = 0 on.
  std::string image = "P5 40 40 255\n";
  for (int row = 0; row < 40; ++row) image += std::string(20, '\xfe') + std::string(20, '\xcd');
  write_file(folder / "map.pgm", image);
  const auto load = [&](const std::string& extra, const std::string& origin) {
    write_file(folder / "map.yaml", "image: map.pgm\nresolution: 0.1\norigin: " + origin +
                                        "\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.25\n");
    return parse_scenario(
        "map: map.yaml\n" + extra + "robots: [{id: 0, start_m: [-1, 0], goals_m: [[1, 0]]}]\n",
        folder / "scenario.yaml");
  };
  CHECK_THROWS_WITH(load("", "[-2, -2, 0]"), ContainsSubstring("goal of robot 0"));
  CHECK_THROWS_WITH(load("unknown: blocked\n", "[-2, -2, 0]"), ContainsSubstring("goal of robot 0"));
  CHECK(load("unknown: free\n", "[-2, -2, 0]").map->notice() ==
        "map map.yaml: 800 of 1600 cells are unknown; they count as free");
  CHECK_THAT(load("unknown: free\n", "[-2, 2, -1.5707963267948966]").map->notice(),
             ContainsSubstring("map map.yaml is rotated by -1.5708 rad"));
  CHECK_THROWS_WITH(load("unknown: perhaps\n", "[-2, -2, 0]"),
                    ContainsSubstring("scenario.yaml:2: unknown: "));
  check_rejected(kRobot + "unknown: free\n", 2, "expected only together with the key map");
  // A path that begins with ~ is relative to the user's home folder.
  const std::string home = std::getenv("HOME") ? std::getenv("HOME") : "";
  setenv("HOME", (folder / "").c_str(), 1);
  const auto at_home = [&] {
    return parse_scenario("map: ~/map.yaml\nunknown: free\n" + kRobot, "elsewhere.yaml").map->cells().grid();
  };
  CHECK(at_home().columns == 40);
  setenv("HOME", home.c_str(), 1);
}

TEST_CASE("starts and goals inside an obstacle or outside the field are rejected") {
  const std::string obstacle = "obstacles: [{centre_m: [2, 0], radius_m: 0.2}]\n";
  const auto robot = [](const char* start, const char* goal) {
    return std::string("robots:\n- id: 0\n  start_m: ") + start + "\n  goals_m: [" + goal + "]\n";
  };
  check_rejected(obstacle + robot("[1.697, 0]", "[0, 0]"), 4,
                 "start of robot 0 (1.697, 0) is inside the obstacle");
  check_rejected(obstacle + robot("[0, 0]", "[0, 1],\n    [2.1, 0.1], [0, 0]"), 6, "goal of robot 0");
  CHECK(error_of(obstacle + robot("[1.696, 0]", "[2.304, 0]")) == "accepted");
  check_rejected(robot("[4.411, 0]", "[0, 0]"), 3, "outside the field: expected |x| <= 4.41 and |y| <= 2.91");
  check_rejected(robot("[0, 0]", "[0, -2.92]"), 4, "outside the field");
  CHECK(error_of(robot("[4.41, 2.91]", "[-4.41, -2.91]")) == "accepted");
  check_rejected(
      "field: {length_m: 99, width_m: 99}\nstreams:\n  count: 9\n  spacing_m: 1\n  lanes_crossed: 6\n", 5,
      "multiple of 4");
  check_rejected("field: {length_m: 2, width_m: 2}\ncircle: {count: 40, spacing_m: 0.4}\n", 2,
                 "outside the field");
}

TEST_CASE("text that is not a single YAML document is rejected with its line") {
  check_rejected("robots: [\n  {id: 0\n", 3, "not YAML");
  check_rejected("field: {length_m: 3}\n bad\n", 2, "not YAML");
  check_rejected("", 1, "the file is empty");
  check_rejected(kRobot + "---\n" + kRobot, 2, "a second YAML document");
  check_rejected("\x01\x02\xff", 1, "");
  check_rejected("# , endless in yaml-cpp's LoadAll\n, x_# y\nfield: {length_m: 3}\n", 2, "");
  check_rejected(std::string(100000, '['), 1, "expected at most 500 nested brackets");
}

TEST_CASE("a file with too many values is rejected, even if anchors multiply the values") {
  std::string many = kRobot + "obstacles: [";
  for (int i = 0; i < 400'000; ++i) many += "0,";
  check_rejected(many + "]\n", 2, "more than 400000 values");
  std::string laughs = "a0: &a0 [0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\n";
  for (int i = 1; i < 30; ++i) {
    laughs += fmt::format("a{}: &a{} [", i, i);
    for (int k = 0; k < 10; ++k) laughs += fmt::format("*a{},", i - 1);
    laughs += "]\n";
  }
  check_rejected(laughs, 6, "more than 400000 values");
  std::string scalars = kRobot + "x: &x 1\ny:\n";
  for (int i = 0; i < 400'000; ++i) scalars += "- *x\n";
  check_rejected(scalars, 399'985, "more than 400000 values");
  std::string walls = kRobot + "obstacles:\n  - wall: &w {thickness_m: 0.1, points_m: [";
  for (int i = 0; i < 900; ++i) walls += fmt::format("[{}, {}],", i % 2, 3 + i % 3);
  walls += "]}\n";
  for (int i = 0; i < 12; ++i) walls += "  - wall: *w\n";
  check_rejected(walls, 3, "the walls have more than 10000 pieces");
}

TEST_CASE("unreadable files are rejected") {
  const auto load_error = [](const std::string& path) -> std::string {
    try {
      (void)load_scenario(path);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "accepted";
  };
  CHECK_THAT(load_error("/nowhere/x.yaml"),
             StartsWith("/nowhere/x.yaml: cannot read the file (No such file"));
  CHECK_THAT(load_error("/tmp"), StartsWith("/tmp: cannot read the file (it is a directory"));
}

TEST_CASE("a mutated scenario either loads or is rejected with a ConfigError") {
  const std::uint64_t seed = 20261121;
  CAPTURE(seed);
  Rng rng(seed);
  const std::string alphabet = "[]{}:,-&*!|>'\"%@`#?\n \t0123456789.eEinfa~\xff\x01";
  int accepted = 0, rejected = 0;
  for (const char* name : {"crossing.yaml", "crossing-noisy.yaml", "circle-20.yaml", "two-teams-22.yaml"}) {
    const std::string valid = text_of(kScenarios + name);
    for (int round = 0; round < 1500; ++round) {
      std::string text = valid;
      for (auto edits = 1 + rng.below(4); edits > 0 && !text.empty(); --edits) {
        const std::size_t at = rng.below(text.size());
        const std::size_t length = std::min<std::size_t>(1 + rng.below(12), text.size() - at);
        switch (rng.below(4)) {
          case 0:
            text[at] = alphabet[rng.below(alphabet.size())];
            break;
          case 1:
            text.erase(at, length);
            break;
          case 2:
            text.insert(at, 1, alphabet[rng.below(alphabet.size())]);
            break;
          default:
            text.insert(rng.below(text.size()), text.substr(at, length));
            break;
        }
      }
      CAPTURE(text);
      try {
        const Scenario scenario = parse_scenario(text, name);
        REQUIRE_FALSE(scenario.robots.empty());
        ++accepted;
      } catch (const ConfigError& error) {
        REQUIRE_THAT(error.what(), StartsWith(std::string(name) + ":"));
        ++rejected;
      }
    }
  }
  CHECK(accepted > 100);
  CHECK(rejected > 1000);
}

}  // namespace sidestep::scenario_error_test
