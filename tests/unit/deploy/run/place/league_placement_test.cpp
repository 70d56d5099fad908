// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/place/league_placement.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "simulator/bases/league_commands.hpp"
#include "tests/catch.hpp"

namespace sidestep::league_placement_test {
namespace {

using namespace std::chrono_literals;

constexpr Time kBegin = time_from_ns(1'000'000'000'000);

Scenario two_robots() {
  Scenario scenario;
  scenario.field = {12, 9};
  scenario.robots.resize(2);
  scenario.robots[0].id = 3;
  scenario.robots[0].start_m = {-1, 0.5};
  scenario.robots[1].id = 16;
  scenario.robots[1].team = Team::kYellow;
  scenario.robots[1].start_m = {1, -0.5};
  scenario.robots[1].start_heading_rad = 3.1;
  return scenario;
}

/// A floor of eleven robots a team, in virtual time, with frames of one camera at 60 Hz that are 50 ms old.
class LeagueFloor {
 public:
  explicit LeagueFloor(const Scenario& scenario)
      : placement(scenario), world(scenario, 11, BaseSettings{}, kBegin) {}

  /// Lets the placement act for some time.
  void run(Duration duration) {
    for (const Time until = now_ + duration; now_ < until; now_ += 17ms) step();
  }
  std::set<std::string> on_floor() const {
    std::set<std::string> names;
    for (std::size_t i = 0; i < world.bodies().size(); ++i) {
      const RobotSpec& robot = world.floor().robots[i];
      if (world.bodies()[i].is_on_floor())
        names.insert((robot.team == Team::kBlue ? "blue " : "yellow ") +
                     std::to_string(number_in_team(robot.id)));
    }
    return names;
  }

  LeaguePlacement placement;
  BaseWorld world;
  std::vector<league::SimulatorCommand> commands;
  bool has_vision = true, obeys = true;

 private:
  void step() {
    world.advance(now_);
    if (has_vision) delayed_.push_back(frame());
    if (delayed_.size() > 3) {
      placement.on_frame(delayed_.front(), now_);
      delayed_.erase(delayed_.begin());
    }
    const auto command = placement.update(now_);
    if (!command) return;
    commands.push_back(*command);
    std::optional<double> speed;
    if (obeys) placement.on_answer(LeagueCommands(world, false).on_control(*command, speed));
  }

  league::DetectionFrame frame() const {
    league::DetectionFrame frame;
    for (std::size_t i = 0; i < world.bodies().size(); ++i) {
      const Body& body = world.bodies()[i];
      const RobotSpec& robot = world.floor().robots[i];
      if (!body.is_on_floor()) continue;
      league::DetectedRobot detected;
      detected.number = number_in_team(robot.id);
      detected.position_m = body.position_m();
      detected.heading_rad = body.heading_rad();
      (robot.team == Team::kBlue ? frame.blue : frame.yellow).push_back(detected);
    }
    if (world.ball()) frame.balls.push_back({world.ball()->state().position_m, {}, 1, {0, 0}, {}});
    return frame;
  }

  Time now_ = kBegin;
  std::vector<league::DetectionFrame> delayed_;
};

}  // namespace

TEST_CASE("robots that are not in the scenario are removed, and misplaced ones are placed") {
  LeagueFloor floor(two_robots());
  floor.world.place(0, {2, 2}, 1);
  REQUIRE(floor.on_floor().size() == 22);
  floor.run(5s);
  CHECK(floor.placement.is_done());
  CHECK(floor.on_floor() == std::set<std::string>{"blue 3", "yellow 0"});
  CHECK(floor.placement.removed() == 20);
  CHECK(floor.placement.placed() == 1);
  CHECK(floor.world.bodies()[0].position_m() == Vec2(-1, 0.5));
}

TEST_CASE("robots are removed before others are placed, so that none is placed where another stands") {
  LeagueFloor floor(two_robots());
  floor.world.place(0, {1, -0.5}, 0);
  floor.world.place(1, {-1, 0.5}, 0);
  floor.run(5s);
  CHECK(floor.placement.is_done());
  REQUIRE(floor.commands.size() == 2);
  for (const league::RobotTeleport& robot : floor.commands[0].robots) CHECK(robot.is_present == false);
  CHECK(floor.commands[1].robots.size() == 2);
  msg::GroundTruth truth;
  floor.world.fill(truth);
  CHECK(truth.contacts() == 0);
}

TEST_CASE("a floor that is as in the scenario gets no command") {
  const Scenario scenario = two_robots();
  LeagueFloor floor(scenario);
  for (std::size_t i = scenario.robots.size(); i < floor.world.bodies().size(); ++i) floor.world.remove(i);
  floor.run(2s);
  CHECK(floor.placement.is_done());
  CHECK(floor.commands.empty());
}

TEST_CASE("an absent robot is removed") {
  Scenario scenario = two_robots();
  scenario.robots[0].is_absent = true;
  LeagueFloor floor(scenario);
  floor.world.place(0, {2, 2}, 1);
  floor.run(5s);
  CHECK(floor.placement.is_done());
  CHECK(floor.on_floor() == std::set<std::string>{"yellow 0"});
}

TEST_CASE("a turned robot is placed again") {
  LeagueFloor floor(two_robots());
  floor.world.place(0, {-1, 0.5}, 1.5);
  floor.run(5s);
  CHECK(floor.placement.is_done());
  CHECK(floor.world.bodies()[0].heading_rad() == 0);
}

TEST_CASE("the ball is placed, at rest or rolling") {
  const Vec2 velocity_mps = GENERATE(Vec2(0, 0), Vec2(0.5, 0));
  Scenario scenario = two_robots();
  LeagueFloor floor([&] {
    scenario.ball = BallSpec{{0.5, 1}, velocity_mps};
    return scenario;
  }());
  floor.world.set_ball({{-2, -2}, {0, 0}});
  floor.run(5s);
  CHECK(floor.placement.is_done());
  CHECK(std::ranges::count_if(floor.commands, [](const auto& command) { return command.ball.has_value(); }) ==
        1);
  CHECK(floor.world.ball()->state().position_m.y() == 1);
}

TEST_CASE("a scenario without a ball leaves the ball where it is") {
  LeagueFloor floor(two_robots());
  floor.world.set_ball({{-2, -2}, {0, 0}});
  floor.run(5s);
  CHECK(floor.placement.is_done());
  CHECK(floor.world.ball()->state().position_m == Vec2(-2, -2));
}

TEST_CASE("what keeps vision from agreeing is named") {
  LeagueFloor floor(two_robots());
  CHECK(floor.placement.problem() == "no detections from vision");
  SECTION("a simulator that does not answer") {
    floor.obeys = false;
    floor.run(5s);
    CHECK_FALSE(floor.placement.is_done());
    CHECK_THAT(floor.placement.problem(), ContainsSubstring("blue robot 0 is not in the scenario") &&
                                              ContainsSubstring("16 more differences") &&
                                              ContainsSubstring("the simulator does not answer"));
    // No robot is to be placed, so the wrong ones are to be removed in each command.
    CHECK(floor.commands.size() > 3);
    for (const league::SimulatorCommand& command : floor.commands) CHECK(command.robots.size() == 20);
  }
  SECTION("a robot that is turned at its place") {
    LeaguePlacement placement(two_robots());
    league::DetectionFrame frame;
    frame.blue.resize(1);
    frame.blue[0].number = 3;
    frame.blue[0].position_m = {-1, 0.5};
    frame.blue[0].heading_rad = 1.5;
    placement.on_frame(frame, kBegin);
    (void)placement.update(kBegin + 1s);
    CHECK_THAT(placement.problem(), ContainsSubstring("blue robot 3 is turned by 1.50 rad"));
  }
  SECTION("a simulator that refuses") {
    floor.obeys = false;
    floor.placement.on_answer({{{"UNKNOWN_ROBOT", "there is no blue robot 3"}}});
    floor.run(5s);
    CHECK_THAT(floor.placement.problem(),
               ContainsSubstring("the simulator answers UNKNOWN_ROBOT there is no"));
  }
  SECTION("vision that ends") {
    floor.run(600ms);
    floor.has_vision = false;
    floor.run(5s);
    CHECK_FALSE(floor.placement.is_done());
    CHECK_THAT(floor.placement.problem(), ContainsSubstring("no detections from vision since"));
  }
}

TEST_CASE("after a silence of vision, the frames of all cameras are awaited before the floor is judged") {
  LeaguePlacement placement(two_robots());
  league::DetectionFrame first, second;
  first.blue.resize(1);
  first.blue[0].number = 3;
  first.blue[0].position_m = {-1, 0.5};
  second.yellow.resize(1);
  second.yellow[0].number = 0;
  second.yellow[0].position_m = {1, -0.5};
  placement.on_frame(first, kBegin);
  CHECK_FALSE(placement.update(kBegin + 400ms));
  CHECK(placement.update(kBegin + 1s));
  CHECK_FALSE(placement.update(kBegin + 5s));
  CHECK_THAT(placement.problem(), ContainsSubstring("no detections from vision since the last command"));
  placement.on_frame(first, kBegin + 10s);
  CHECK_FALSE(placement.update(kBegin + 10s));
  placement.on_frame(second, kBegin + 10s + 100ms);
  CHECK_FALSE(placement.update(kBegin + 11s));
  CHECK(placement.is_done());
}

TEST_CASE("a robot seen at a place that is not a number is never right") {
  LeaguePlacement placement(two_robots());
  league::DetectionFrame frame;
  league::DetectedRobot robot;
  robot.number = 3;
  robot.position_m = {NAN, 0.5};
  frame.blue.push_back(robot);
  placement.on_frame(frame, kBegin);
  CHECK(placement.update(kBegin + 1s));
  CHECK_FALSE(placement.is_done());
}

}  // namespace sidestep::league_placement_test
