// SPDX-License-Identifier: Apache-2.0
#include "common/config/scenario_loader.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "common/random/rng.hpp"

namespace sidestep {
namespace {

const std::string kScenarios = SIDESTEP_SOURCE_DIR "/deploy/scenarios/";

std::string refusal(const std::string& text) {
  try {
    parse_scenario(text, "file.yaml");
  } catch (const ScenarioError& error) {
    return error.what();
  }
  return "accepted";
}

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

const std::string kRobot = "robots: [{id: 0, start_m: [0, 0], goals_m: [[1, 0]]}]\n";

void check_refused(const std::string& text, int line, const std::string& why) {
  CAPTURE(text);
  const std::string said = refusal(text);
  CHECK_THAT(said, Catch::StartsWith("file.yaml:" + std::to_string(line) + ": "));
  CHECK_THAT(said, Catch::Contains(why));
}

}  // namespace

TEST_CASE("every shipped scenario loads") {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kScenarios)) {
    if (entry.path().extension() != ".yaml") continue;
    CAPTURE(entry.path());
    const Scenario scenario = load_scenario(entry.path().string());
    CHECK(scenario.name == entry.path().stem());
    CHECK_FALSE(scenario.robots.empty());
    ++count;
  }
  CHECK(count >= 5);
}

TEST_CASE("the shipped scenarios hold what they are named for") {
  CHECK(load_scenario(kScenarios + "crossing.yaml").robots.size() == 8);
  CHECK(load_scenario(kScenarios + "crossing.yaml").obstacles.size() == 4);
  CHECK(load_scenario(kScenarios + "two-teams-22.yaml").robots.size() == 22);
  CHECK(load_scenario(kScenarios + "two-teams-22.yaml").field.length_m == 12);
  const Scenario noisy = load_scenario(kScenarios + "crossing-noisy.yaml");
  CHECK(noisy.vision.position_noise_m == 0.0015);
  CHECK(noisy.vision.delay == std::chrono::milliseconds(35));
  CHECK(noisy.vision.missed == 0.02);
  CHECK(noisy.command_loss == 0.03);
}

TEST_CASE("a circle puts neighbours one spacing apart and every goal opposite") {
  const Scenario scenario = load_scenario(kScenarios + "circle-100.yaml");
  const auto& robots = scenario.robots;
  REQUIRE(robots.size() == 100);
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const RobotSpec& next = robots[(i + 1) % robots.size()];
    CHECK((robots[i].start_m - next.start_m).norm() == Approx(0.4));
    CHECK((robots[i].goals.back().position_m + robots[i].start_m).norm() == Approx(0).margin(1e-9));
    CHECK(robots[i].team != next.team);
  }
}

TEST_CASE(
    "streams give each robot a square of its own, and a way across so many lanes in one of four directions") {
  const Scenario scenario = load_scenario(kScenarios + "streams-1000.yaml");
  const auto& robots = scenario.robots;
  REQUIRE(robots.size() == 1000);
  std::map<std::pair<int, int>, int> directions;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if ((robots[i].start_m - robots[j].start_m).norm() < 0.8366) FAIL("starts of " << i << " and " << j);
    }
    const Vec2 way = robots[i].goals.back().position_m - robots[i].start_m;
    CHECK(way.norm() == Approx(12 * 0.83666));
    ++directions[{static_cast<int>(std::lround(way.x())), static_cast<int>(std::lround(way.y()))}];
  }
  REQUIRE(directions.size() == 4);
  for (const auto& [direction, count] : directions) CHECK(count > 200);
}

TEST_CASE("every key is read in its unit") {
  const Scenario s = parse_scenario(R"(name: all-keys
field: {length_m: 12, width_m: 9}
limits: {acceleration_mps2: 2.5, deceleration_mps2: 4, speed_mps: 1.5}
radius_m: 0.08
margin_m: 0.02
tracking_bound_m: 0.004
clock_bound_s: 0.001
control_rate_hz: 50
goal_tolerance_m: 0.03
time_limit_s: 12.5
vision: {rate_hz: 30, columns: 4, rows: 3, overlap_m: 0.25, position_noise_m: 0.002, heading_noise_rad: 0.01,
         delay_ms: 12.5, missed: 0.1, ghosts: 0.2}
odometry: {scale_error: 0.01, velocity_noise_mps: 0.02}
command_loss: 0.25
network: {loss: 0.3, duplicate: 0.1, delay_min_ms: 0, delay_max_ms: 150}
restart: [agents, vision]
coordinators: 3
ball: {position_m: [1, 2], velocity_mps: [-1, 0.5]}
obstacles: [{centre_m: [3, 3], radius_m: 0.5}]
opponents:
  - {radius_m: 0.3, speed_mps: 0.75, way_m: [[4, 1], [4, -1], [3, -1]]}
  - {radius_m: 0.2, speed_mps: 2.5, way_m: [[-4, 0]]}
opponent_speed_mps: 2.5
robots:
  - {id: 7, team: yellow, start_m: [1, -2], heading_rad: 1.5, clock_offset_ms: -1.25, absent: true, goals_m: [[2, 2], [-2, 2, -0.5]]}
  - {id: 3, start_m: [0, 0], goals_m: [[1, 1]]}
)",
                                    "x.yaml");
  CHECK(s.name == "all-keys");
  CHECK(s.field.length_m == 12);
  CHECK(s.field.width_m == 9);
  CHECK(s.limits.acceleration_mps2 == 2.5);
  CHECK(s.limits.deceleration_mps2 == 4);
  CHECK(s.limits.speed_mps == 1.5);
  CHECK(s.radius_m == 0.08);
  CHECK(s.margin_m == 0.02);
  CHECK(s.tracking_bound_m == 0.004);
  CHECK(s.clock_bound_s == 0.001);
  CHECK(s.cycle == std::chrono::milliseconds(20));
  CHECK(s.goal_tolerance_m == 0.03);
  CHECK(s.time_limit_s == 12.5);
  CHECK(s.vision.rate_hz == 30);
  CHECK(s.vision.columns == 4);
  CHECK(s.vision.rows == 3);
  CHECK(s.vision.overlap_m == 0.25);
  CHECK(s.vision.position_noise_m == 0.002);
  CHECK(s.vision.heading_noise_rad == 0.01);
  CHECK(s.vision.delay == std::chrono::microseconds(12500));
  CHECK(s.vision.missed == 0.1);
  CHECK(s.vision.ghosts == 0.2);
  CHECK(s.odometry.scale_error == 0.01);
  CHECK(s.odometry.velocity_noise_mps == 0.02);
  CHECK(s.command_loss == 0.25);
  CHECK(s.network.loss == 0.3);
  CHECK(s.network.duplicate == 0.1);
  CHECK(s.network.delay_min == Duration{0});
  CHECK(s.network.delay_max == std::chrono::milliseconds(150));
  CHECK(s.coordinators == 3);
  CHECK((s.restart.agents && s.restart.vision && !s.restart.coordinator));
  REQUIRE(s.ball);
  CHECK(s.ball->velocity_mps == Vec2(-1, 0.5));
  REQUIRE(s.obstacles.size() == 1);
  CHECK(s.obstacles[0].radius_m == 0.5);
  CHECK(s.opponent_speed_mps == 2.5);
  REQUIRE(s.opponents.size() == 2);
  CHECK(s.opponents[0].radius_m == 0.3);
  CHECK(s.opponents[0].speed_mps == 0.75);
  CHECK(s.opponents[0].way_m == std::vector<Vec2>{{4, 1}, {4, -1}, {3, -1}});
  REQUIRE(s.robots.size() == 2);
  CHECK(s.robots[0].id == 3);
  CHECK_FALSE(s.robots[0].is_absent);
  CHECK(s.robots[1].is_absent);
  CHECK(s.robots[1].clock_offset == -std::chrono::microseconds(1250));
  const RobotSpec* seven = find_robot(s, 7);
  REQUIRE(seven != nullptr);
  CHECK(seven->team == Team::kYellow);
  CHECK(seven->start_heading_rad == 1.5);
  CHECK(seven->goals[1].position_m == Vec2(-2, 2));
  CHECK(seven->goals[1].heading_rad == -0.5);
  CHECK_FALSE(seven->goals[0].heading_rad);
  CHECK(find_robot(s, 5) == nullptr);
  CHECK(find_robot(s, 8) == nullptr);
}

TEST_CASE("missing keys leave the struct's defaults") {
  const Scenario given = parse_scenario(kRobot, "dir/lone.yaml"), usual;
  CHECK(given.name == "lone");
  CHECK(given.cycle == usual.cycle);
  CHECK(given.vision.delay == usual.vision.delay);
  CHECK(given.margin_m == usual.margin_m);
  CHECK(given.time_limit_s == usual.time_limit_s);
  CHECK_FALSE(given.ball);
}

TEST_CASE("a margin below the safety budget is refused with the margin that is needed") {
  // 2 x 3 mm + 2 x 0.5 ms x 2 x 2 m/s: the defaults fit each other exactly.
  CHECK(budget_of(Scenario{}).needed_margin_m() == Approx(0.01).epsilon(1e-12));
  CHECK(refusal(kRobot + "margin_m: 0.01\n") == "accepted");
  check_refused(kRobot + "margin_m: 0.0099\n", 2, "expected at least 0.01 m");
  check_refused(kRobot + "\nlimits: {speed_mps: 3}\n", 1, "margin_m: 0.01 m is less than the safety budget");
  check_refused(kRobot + "limits: {speed_mps: 3}\nmargin_m: 0.011\n", 3, "expected at least 0.012 m");
  CHECK(refusal(kRobot + "limits: {speed_mps: 3}\nmargin_m: 0.012\n") == "accepted");
  check_refused(kRobot + "tracking_bound_m: 0.005\n", 1, "expected at least 0.014 m");
  check_refused(kRobot + "clock_bound_s: 0.002\nmargin_m: 0.02\n", 3, "expected at least 0.022 m");
  CHECK(refusal(kRobot + "clock_bound_s: 0\nmargin_m: 0.006\n") == "accepted");
  check_refused(kRobot + "tracking_bound_m: 0\n", 2, "tracking_bound_m: expected 0.0005 to 1");
  check_refused(kRobot + "clock_bound_s: .nan\n", 2, "clock_bound_s: expected");
}

TEST_CASE("opponents that make no sense are refused with their line") {
  const auto opponent = [](const std::string& keys) { return kRobot + "opponents:\n- {" + keys + "}\n"; };
  CHECK(refusal(opponent("radius_m: 0.1, speed_mps: 1.5, way_m: [[2, 2]]")) == "accepted");
  check_refused(opponent("speed_mps: 1, way_m: [[2, 2]]"), 3, "key \"radius_m\" is missing");
  check_refused(opponent("radius_m: 0.1, way_m: [[2, 2]]"), 3, "key \"speed_mps\" is missing");
  check_refused(opponent("radius_m: 0.1, speed_mps: 1"), 3, "key \"way_m\" is missing");
  check_refused(opponent("radius_m: 0.1, speed_mps: 1, way_m: []"), 3, "expected at least one point");
  check_refused(opponent("radius_m: 0.1, speed_mps: 1, way_m: [[2, 2, 2]]"), 3, "a list of 2 numbers, got 3");
  check_refused(opponent("radius_m: 0.1, speed_mps: 1, way_m: [[2, .nan]]"), 3, "expected");
  check_refused(opponent("radius_m: 0, speed_mps: 1, way_m: [[2, 2]]"), 3, "radius_m: expected 0.01 to 5");
  check_refused(opponent("radius_m: 0.1, speed_mps: 0, way_m: [[2, 2]]"), 3,
                "speed_mps: expected 0.01 to 20");
  check_refused(opponent("radius_m: 0.1, speed_mps: 1.6, way_m: [[2, 2]]"), 3,
                "opponents[0].speed_mps: expected at most opponent_speed_mps, 1.5, got 1.6");
  CHECK(refusal("opponent_speed_mps: 1.6\n" + opponent("radius_m: 0.1, speed_mps: 1.6, way_m: [[2, 2]]")) ==
        "accepted");
  check_refused(opponent("radius_m: 0.1, speed_mps: 1, way_m: [[0.1, 0.16]]"), 1, "where an opponent begins");
  std::string many = kRobot + "opponents:\n";
  for (int i = 0; i < 17; ++i) many += "- {radius_m: 0.1, speed_mps: 1, way_m: [[2, 2]]}\n";
  check_refused(many, 3, "expected at most 16 elements, got 17");
}

TEST_CASE("an absent robot is in nobody's way until it is placed") {
  const auto pair = [](const std::string& how) {
    return "robots:\n- {id: 0, start_m: [0, 0], goals_m: [[1, 0]]}\n- {id: 1, start_m: [0, 0.1], goals_m: "
           "[[2, "
           "0]]" +
           how + "}\n";
  };
  check_refused(pair(""), 3, "starts of robots 0 and 1 overlap");
  check_refused(pair(", absent: false"), 3, "starts of robots 0 and 1 overlap");
  CHECK(refusal(pair(", absent: true")) == "accepted");
  check_refused(pair(", absent: 1"), 3, "absent: expected true or false, got \"1\"");
  check_refused(pair(", absent: \"true\""), 3, "expected true or false");
  check_refused(pair(", absent: true, clock_offset_ms: 60001"), 3,
                "clock_offset_ms: expected -60000 to 60000");
}

TEST_CASE("unknown and repeated keys are refused with their line") {
  check_refused(kRobot + "margin: 0.1\n", 2, "unknown key \"margin\", expected one of: ");
  check_refused(kRobot + "vision:\n  rate_hz: 60\n  dely_ms: 3\n", 4, "unknown key \"dely_ms\"");
  check_refused("robots:\n  - id: 0\n    start_m: [0, 0]\n    goals_m: [[1, 0]]\n    colour: red\n", 5,
                "unknown key \"colour\"");
  check_refused(kRobot + "obstacles:\n  - {centre_m: [2, 2], radius_m: 0.1, hight_m: 3}\n", 3, "unknown key");
  check_refused(kRobot + "circle:\n  count: 4\n  spacing_m: 1\n  radius_m: 3\n", 5,
                "unknown key \"radius_m\"");
  check_refused(kRobot + "margin_m: 0.1\nradius_m: 0.1\nmargin_m: 0.1\n", 4,
                "\"margin_m\" stands here twice");
  check_refused(kRobot + "vision:\n  missed: 0\n  missed: 0\n", 4, "twice");
}

TEST_CASE("values of a wrong type are refused with their line") {
  check_refused(kRobot + "margin_m: wide\n", 2, "expected a number from 0 to 1, got \"wide\"");
  check_refused(kRobot + "margin_m: \"0.1\"\n", 2, "expected a number");
  check_refused(kRobot + "margin_m: 0.1m\n", 2, "expected a number");
  check_refused(kRobot + "margin_m:\n", 2, "expected a number");
  check_refused(kRobot + "margin_m: [0.1]\n", 2, "got a list");
  check_refused(kRobot + "vision: 3\n", 2, "expected a mapping");
  check_refused(kRobot + "vision:\n  columns: 2.5\n", 3, "expected a whole number");
  check_refused(kRobot + "obstacles: {centre_m: [0, 0]}\n", 2, "expected a list");
  check_refused(kRobot + "obstacles:\n- 3\n", 3, "expected a mapping");
  check_refused(kRobot + "restart:\n- agents\n- everything\n", 4, "expected agents, coordinator or vision");
  check_refused(kRobot + "ball: {position_m: [1]}\n", 2, "expected a list of 2 numbers, got 1");
  check_refused("robots:\n- {id: 0, team: red, start_m: [0, 0], goals_m: [[1, 0]]}\n", 2,
                "expected blue or yellow");
  check_refused("robots:\n- {id: 0, start_m: [0, 0], goals_m: [1, 0]}\n", 2,
                "expected a list of 2 to 3 numbers");
  check_refused("robots:\n- id: 0\n  start_m: [0, 0]\n  goals_m:\n  - [1, 0]\n  - [1, 0, 0, 0]\n", 6,
                "got 4");
  check_refused("robots: 4\n", 1, "expected a list");
  check_refused("? [a, b]\n: 3\n", 1, "expected a key");
  check_refused("- 1\n- 2\n", 1, "expected a mapping");
  check_refused(kRobot + "name: [a]\n", 2, "expected text");
  check_refused(kRobot + "name: ../../x\n", 2, "letters, digits");
}

TEST_CASE("numbers out of range, infinite or not numbers are refused with their line") {
  for (const char* bad : {".nan", "nan", ".inf", "-.inf", "inf", "-0.001", "1.001", "1e400", "--1"}) {
    check_refused(kRobot + "\nmargin_m: " + bad + "\n", 3, "margin_m: expected");
  }
  check_refused(kRobot + "network: {delay_min_ms: 5,\n delay_max_ms: 4}\n", 3,
                "expected at least delay_min_ms");
  check_refused(kRobot + "coordinators: 0\n", 2, "expected 1 to 8, got 0");
  check_refused(kRobot + "coordinators: 9\n", 2, "expected 1 to 8, got 9");
  check_refused(kRobot + "ball: {position_m: [5, 0]}\n", 2, "outside the field");
  check_refused("robots:\n- id: 1024\n  start_m: [0, 0]\n  goals_m: [[1, 0]]\n", 2,
                "expected 0 to 1023, got 1024");
  check_refused("robots:\n- {id: -1, start_m: [0, 0], goals_m: [[1, 0]]}\n", 2, "expected 0 to 1023, got -1");
  check_refused("robots:\n- {id: 1, start_m: [0, 0], goals_m: [[1, 0, 9]]}\n", 2, "expected -6.28");
}

TEST_CASE("missing robots, ids, starts and goals are refused") {
  check_refused("field: {length_m: 4}\n", 1, "no robots");
  check_refused("robots: []\n", 1, "no robots");
  check_refused("robots:\n- {start_m: [0, 0], goals_m: [[1, 0]]}\n", 2, "key \"id\" is missing");
  check_refused("robots:\n- {id: 1, goals_m: [[1, 0]]}\n", 2, "key \"start_m\" is missing");
  check_refused("robots:\n- {id: 1, start_m: [0, 0]}\n", 2, "key \"goals_m\" is missing");
  check_refused("robots:\n- {id: 1, start_m: [0, 0],\n   goals_m: []}\n", 3, "at least one goal");
  check_refused(kRobot + "obstacles:\n- {centre_m: [2, 2]}\n", 3, "key \"radius_m\" is missing");
}

TEST_CASE("robots that share an id are refused at the second") {
  check_refused(
      "robots:\n"
      "- {id: 4, start_m: [0, 0], goals_m: [[1, 0]]}\n"
      "- {id: 2, start_m: [0, 1], goals_m: [[1, 1]]}\n"
      "- {id: 4, start_m: [0, 2], goals_m: [[1, 2]]}\n",
      4, "robot id 4 is used twice");
  check_refused("circle: {count: 5, spacing_m: 0.5}\n" + kRobot, 1, "used twice");
}

TEST_CASE("more robots than ids are refused") {
  check_refused("field: {length_m: 900, width_m: 900}\ncircle:\n  count: 1025\n  spacing_m: 0.4\n", 3,
                "expected 2 to 1024");
  check_refused(
      "field: {length_m: 900, width_m: 900}\ncircle: {first_id: 1000,\n  count: 25, spacing_m: 0.4}\n", 3,
      "more robots than ids: from id 1000 on expected at most 24, got 25");
  std::string many = "field: {length_m: 900, width_m: 900}\nrobots:\n";
  for (int i = 0; i < 1025; ++i) many += "- {id: 0, start_m: [0, 0], goals_m: [[0, 0]]}\n";
  check_refused(many, 3, "more robots than ids");
}

TEST_CASE("overlapping starts and last goals are refused, exact distance is not") {
  const auto pair = [](double apart, double goals_apart) {
    std::ostringstream text;
    text << "radius_m: 0.09\nmargin_m: 0.01\nrobots:\n- {id: 0, start_m: [0, 0], goals_m: [[0, 0], [1, 1]]}\n"
         << "- {id: 1, start_m: [" << apart << ", 0],\n   goals_m: [[1, 1],\n     [" << 1 + goals_apart
         << ", 1]]}\n";
    return text.str();
  };
  check_refused(pair(0.189, 0.5), 5,
                "starts of robots 0 and 1 overlap: distance 0.1890 m, expected at least 0.1900");
  check_refused(pair(0.5, 0.189), 7, "last goals of robots 0 and 1 overlap");
  CHECK(refusal(pair(0.19, 0.19)) == "accepted");
}

TEST_CASE("starts and goals in an obstacle or outside the field are refused") {
  const std::string obstacle = "obstacles: [{centre_m: [2, 0], radius_m: 0.2}]\n";
  const auto robot = [](const char* start, const char* goal) {
    return std::string("robots:\n- id: 0\n  start_m: ") + start + "\n  goals_m: [" + goal + "]\n";
  };
  check_refused(obstacle + robot("[1.701, 0]", "[0, 0]"), 4,
                "start of robot 0 (1.701, 0) is inside the obstacle");
  check_refused(obstacle + robot("[0, 0]", "[0, 1],\n    [2.1, 0.1], [0, 0]"), 6, "goal of robot 0");
  CHECK(refusal(obstacle + robot("[1.7, 0]", "[2.3, 0]")) == "accepted");
  check_refused(robot("[4.411, 0]", "[0, 0]"), 3, "outside the field: expected |x| <= 4.41 and |y| <= 2.91");
  check_refused(robot("[0, 0]", "[0, -2.92]"), 4, "outside the field");
  CHECK(refusal(robot("[4.41, 2.91]", "[-4.41, -2.91]")) == "accepted");
  check_refused(
      "field: {length_m: 99, width_m: 99}\nstreams:\n  count: 9\n  spacing_m: 1\n  lanes_crossed: 6\n", 5,
      "multiple of 4");
  check_refused("field: {length_m: 2, width_m: 2}\ncircle: {count: 40, spacing_m: 0.4}\n", 2,
                "outside the field");
}

TEST_CASE("what is not one YAML document is refused with its line") {
  check_refused("robots: [\n  {id: 0\n", 3, "not YAML");
  check_refused("field: {length_m: 3}\n bad\n", 2, "not YAML");
  check_refused("", 1, "the file is empty");
  check_refused(kRobot + "---\n" + kRobot, 2, "a second YAML document");
  check_refused("\x01\x02\xff", 1, "");
  check_refused("# , endless in yaml-cpp's LoadAll\n, x_# y\nfield: {length_m: 3}\n", 2, "");
  check_refused(std::string(100000, '['), 1, "not YAML");
}

TEST_CASE("files that cannot be read are refused") {
  const auto said = [](const std::string& path) -> std::string {
    try {
      load_scenario(path);
    } catch (const ScenarioError& error) {
      return error.what();
    }
    return "accepted";
  };
  CHECK_THAT(said("/nowhere/x.yaml"),
             Catch::StartsWith("/nowhere/x.yaml:1: cannot read the file (No such file"));
  CHECK_THAT(said("/tmp"), Catch::StartsWith("/tmp:1: cannot read the file (a directory"));
}

TEST_CASE("a mutated scenario loads or is refused, and never does anything else") {
  const std::uint64_t seed = 20261121;
  CAPTURE(seed);
  Rng rng(seed);
  const std::string alphabet = "[]{}:,-&*!|>'\"%@`#?\n \t0123456789.eEinfa~\xff\x01";
  int accepted = 0, refused = 0;
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
      } catch (const ScenarioError& error) {
        REQUIRE_THAT(error.what(), Catch::StartsWith(std::string(name) + ":"));
        ++refused;
      }
    }
  }
  CHECK(accepted > 100);
  CHECK(refused > 1000);
}

}  // namespace sidestep
