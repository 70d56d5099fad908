// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/picture/run_picture.hpp"

#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "common/json/json_text.hpp"
#include "common/svg/palette.hpp"
#include "deploy/audit/metrics/report.hpp"
#include "tests/catch.hpp"
#include "tests/text_of.hpp"

namespace sidestep::run_picture_test {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

/// The values of an attribute in the order of the picture.
std::vector<std::string> attributes(const std::string& svg, const std::string& name) {
  std::vector<std::string> result;
  const std::regex pattern(" " + name + "='([^']*)'");
  for (std::sregex_iterator match(svg.begin(), svg.end(), pattern), end; match != end; ++match)
    result.push_back((*match)[1]);
  return result;
}

/// Robot 0 drives 1 m along x in 1 s; robot 1 rests and is seen half as long.
Report report() {
  Report result;
  result.scenario = "hall <1>";
  result.program = "simulate";
  result.seed = 7;
  result.robots = 2;
  result.arrived = 2;
  result.makespan_s = 1;
  FloorTrace& trace = result.trace.emplace();
  trace.field = {4, 2};
  trace.robots.push_back(
      {0, Team::kBlue, {-1, 0}, {{0, 0}}, {{0, {-1, 0}, 0}, {0.5, {-0.5, 0}, 1}, {1, {0, 0}, 0}}});
  trace.robots.push_back({1, Team::kBlue, {-1, 0.5}, {}, {{0, {-1, 0.5}, 0}, {0.5, {-1, 0.5}, 0}}});
  return result;
}

std::string picture_of(const Report& report) { return run_picture_from(to_json(report)); }

TEST_CASE(
    "in the picture of a run each robot drives from its start to its end and rests there for a moment") {
  const std::string svg = picture_of(report());
  CAPTURE(svg);
  const std::regex motion(
      "type='translate' values='([^']*)' keyTimes='([^']*)' dur='2.50s' repeatCount='indefinite'");
  std::vector<std::pair<std::string, std::string>> motions;
  for (std::sregex_iterator match(svg.begin(), svg.end(), motion), end; match != end; ++match)
    motions.emplace_back((*match)[1], (*match)[2]);
  REQUIRE(motions.size() == 2);
  double x[4], y[4];
  REQUIRE(std::sscanf(motions[0].first.c_str(), "%lf,%lf;%lf,%lf;%lf,%lf;%lf,%lf", &x[0], &y[0], &x[1], &y[1],
                      &x[2], &y[2], &x[3], &y[3]) == 8);
  CHECK(motions[0].second == "0;0.2;0.4;1");
  CHECK(x[1] - x[0] == Approx(x[2] - x[1]).margin(0.11));
  CHECK(x[3] == x[2]);
  CHECK(y[0] == y[3]);
  // Viewers that do not play show the robot at its end.
  CHECK_THAT(svg, ContainsSubstring("<g transform='translate(" +
                                    motions[0].first.substr(motions[0].first.rfind(';') + 1) +
                                    ")'><title>robot 0</title>"));
}

TEST_CASE("the picture of a run says which run it shows, and how the run ended") {
  const std::string svg = picture_of(report());
  CHECK_THAT(svg, ContainsSubstring(">hall &lt;1&gt;, seed 7</text>") &&
                      ContainsSubstring(">passed: 2 of 2 robots arrived in 1.00 s, 0 contacts; "));
  Report failed = report();
  failed.seed.reset();
  failed.contacts = 3;
  CHECK_THAT(picture_of(failed),
             ContainsSubstring(">hall &lt;1&gt;</text>") && ContainsSubstring(">failed: 3 contacts; "));
}

TEST_CASE("the picture of a run counts the robots without a goal apart from those that arrived") {
  Report mixed = report();
  mixed.robots = 5;
  mixed.without_goal = 3;
  CHECK_THAT(picture_of(mixed),
             ContainsSubstring(">passed: 2 of 2 robots arrived in 1.00 s and 3 had no goal, "));
}

TEST_CASE("the picture of a run has starts, goals, directions, a scale and a legend") {
  const std::string svg = picture_of(report());
  CAPTURE(svg);
  CHECK(count(svg, "<title>start of robot 0</title>") == 1);
  CHECK(count(svg, "<title>start of robot 1</title>") == 1);
  CHECK(count(svg, "<title>goal 0</title>") == 1);
  CHECK(count(svg, "<title>goal 1</title>") == 0);
  for (const char* text : {">start</text>", ">goal</text>", ">robot</text>", ">0.2 m</text>"})
    CHECK(count(svg, text) == 1);
  CHECK_THAT(svg, Matches("[^]*>direction, every 0\\.[0-9]+ s</text>[^]*"));
  CHECK_THAT(svg, !ContainsSubstring(">obstacle</text>") && !ContainsSubstring("times the robots") &&
                      !ContainsSubstring("nan"));
  // Arrows point to the right, where the robot drives: the tip comes first.
  std::smatch arrow;
  REQUIRE(std::regex_search(
      svg, arrow, std::regex("<path d='M([0-9.]+) [0-9.]+L([0-9.]+) [0-9.]+L[^']*z[^']*' fill='#")));
  CHECK(std::stod(arrow[1]) > std::stod(arrow[2]));
}

TEST_CASE("the shipped pictures of runs play, and have starts, goals and a scale") {
  // If not: deploy/scenarios/pictures/draw
  const std::string name = GENERATE("crossing", "circle-20");
  CAPTURE(name);
  const std::string svg = text_of(SIDESTEP_SOURCE_DIR "/deploy/scenarios/pictures/" + name + ".svg");
  for (const char* part : {">start</text>", ">goal</text>", "<animateTransform "})
    CHECK((svg.find(part) != std::string::npos));
  CHECK(std::regex_search(svg, std::regex(">[0-9.]+ m</text>")));
  CHECK_THAT(svg.substr(0, 1000), ContainsSubstring(">passed: "));
}

TEST_CASE("each robot has a colour of its own, in which its path, start and goal are drawn") {
  Report many = report();
  many.trace->robots.resize(22);
  for (RobotId id = 0; id < 22; ++id) {
    const double y_m = -0.9 + 0.08 * id;
    many.trace->robots[id] = {id, Team::kBlue, {-1, y_m}, {{1, y_m}}, {{0, {-1, y_m}, 0}, {1, {1, y_m}, 1}}};
  }
  const std::string svg = picture_of(many);
  for (RobotId id = 0; id < 22; ++id) {
    const std::string stroke = "stroke='" + distinct_colour(id) + "'";
    CAPTURE(id, stroke);
    CHECK(count(svg, stroke) == 3);
    CHECK_THAT(svg, ContainsSubstring(stroke + " stroke-linejoin='round'><title>path of robot " +
                                      std::to_string(id) + "<"));
    CHECK(count(svg, ">" + std::to_string(id) + "</text>") >= 2);  // on the disc and at the goal
  }
}

TEST_CASE("robots in a building of 100 m are as large as in a small room, and the legend says so") {
  Report large = report();
  large.trace->field = {100, 100};
  large.trace->robots[0] = {0, Team::kBlue, {-45, -45}, {{45, 45}}, {{0, {-45, -45}, 0}, {60, {45, 45}, 1}}};
  large.trace->walls = {Box{{-50, 0}, {40, 0.1}}};
  const std::string svg = picture_of(large);
  CAPTURE(svg);
  double smallest_px = 100;
  for (const std::string& radius : attributes(svg, "r"))
    smallest_px = std::min(smallest_px, std::stod(radius));
  CHECK(smallest_px >= 9);
  for (const std::string& size : attributes(svg, "font-size")) CHECK(std::stod(size) >= 9);
  CHECK_THAT(svg, Matches("[^]*>discs: 1[0-9] times the robots&#39; size</text>[^]*"));
  CHECK_THAT(svg, ContainsSubstring(">plays 2 times as fast</text>") && ContainsSubstring(">10 m</text>") &&
                      ContainsSubstring(">obstacle</text>"));
}

TEST_CASE("the picture names the teams if there are two, and marks contacts and opponents") {
  Report mixed = report();
  mixed.trace->robots[1].team = Team::kYellow;
  mixed.trace->incidents = {{0.5, FloorTrace::kContact, {0, 1}, {-0.5, 0}}};
  mixed.trace->opponents = {{0.2, 1, {{0, 0.5}, {1, 0.5}}}};
  mixed.trace->opponents_since_s = 0;
  const std::string svg = picture_of(mixed);
  CAPTURE(svg);
  CHECK_THAT(svg, ContainsSubstring(">yellow team</text>") && ContainsSubstring(">blue team</text>") &&
                      ContainsSubstring("<title>0.50 s: contact of robot 0, 1</title>") &&
                      ContainsSubstring(">person or opponent</text>") &&
                      ContainsSubstring(">contact</text>"));
  CHECK(count(svg, "<animateTransform") == 3);
  CHECK_THAT(picture_of(report()), !ContainsSubstring("team</text>"));
}

TEST_CASE("a thousand robots have no numbers and a picture of limited size") {
  Report crowd = report();
  crowd.trace->field = {30, 30};
  crowd.trace->robots.clear();
  for (RobotId id = 0; id < 1000; ++id) {
    const Vec2 at(-14 + 0.9 * (id % 32), -14 + 0.9 * (id / 32));
    crowd.trace->robots.push_back({id, Team::kBlue, at, {at}, {{0, at, 0}, {9, at + Vec2(0.4, 0), 0}}});
  }
  const std::string svg = picture_of(crowd);
  CHECK(svg.size() < 2'000'000);
  CHECK_THAT(svg, !ContainsSubstring(">999</text>") && !ContainsSubstring("stroke-dashoffset"));
}

TEST_CASE("a robot that was carried far in a moment of a long run does not fill its picture with arrows") {
  Report carried = report();
  carried.trace->robots[0].path = {
      {0, {-1, 0}, 0}, {1e6, {-1, 0}, 0}, {1e6 + 0.001, {1, 0}, 0}, {2e6, {1, 0}, 0}};
  const std::string svg = picture_of(carried);
  CHECK(svg.size() < 20'000);
  CHECK_THAT(svg, ContainsSubstring("<title>path of robot 0</title>") && !ContainsSubstring("nan"));
}

TEST_CASE("a robot that rests for years, or was seen years before the first grant, has few arrows") {
  Report old = report();
  old.trace->robots[0].path.insert(old.trace->robots[0].path.begin(), {-1e9, {-1, 0}, 0});
  CHECK(picture_of(old).size() < 20'000);
  Report resting = report();
  for (FloorTrace::Robot& robot : resting.trace->robots) {
    robot.path.clear();
    for (int i = 0; i <= 20; ++i)  // creeps by less than a pixel from one point to the next
      robot.path.push_back({-1e9 + 1e8 * i, robot.start_m + Vec2(0.001 * i, 0), 0});
  }
  CHECK(picture_of(resting).size() < 20'000);
  Report brief = report();
  for (FloorTrace::Robot& robot : brief.trace->robots)
    robot.path = {{0, robot.start_m, 0}, {1e9, Vec2(1, 0), 0}};
  auto json = parse_ordered_json(to_json(brief));
  for (const char* robot : {"0", "1"}) json["paths"][robot][0][0] = 1e9 - 2e-7;
  CHECK(run_picture(json).size() < 100'000);
}

TEST_CASE("a report without paths gives a picture that says so") {
  Report without = report();
  without.trace.reset();
  CHECK_THAT(picture_of(without), StartsWith("<svg") && ContainsSubstring("This report has no paths"));
}

TEST_CASE("a floor on which nothing was seen is drawn without animation") {
  Report unseen = report();
  for (FloorTrace::Robot& robot : unseen.trace->robots) robot.path.clear();
  const std::string svg = picture_of(unseen);
  CHECK_THAT(svg, !ContainsSubstring("<animate") && !ContainsSubstring("nan") && !ContainsSubstring("inf'") &&
                      ContainsSubstring("<title>start of robot 1</title>"));
}

TEST_CASE("a damaged report is refused") {
  auto json = parse_ordered_json(to_json(report()));
  json["seed"] = nullptr;
  json.erase("failure");
  CHECK_THROWS_AS(run_picture(json), std::invalid_argument);
}

}  // namespace sidestep::run_picture_test
