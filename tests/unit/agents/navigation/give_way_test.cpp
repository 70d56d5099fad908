// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/give_way.hpp"

#include <cmath>
#include <vector>

#include "tests/catch.hpp"

namespace sidestep::give_way_test {

constexpr double kRadius_m = 0.09, kRequired_m = 0.104, kSeparation_m = 0.194;
const Field kField{10, 4};

Time at(double seconds) { return time_from_ns(100'000'000'000) + from_seconds(seconds); }

/// A corridor along the x axis that is 0.3 m wide, with a bay above it at `bay_x_m`.
ObstacleWorld corridor(double bay_x_m) {
  return ObstacleWorld({Box{{-5, -2}, {5, -0.15}}, Box{{-5, 0.15}, {bay_x_m - 0.2, 2}},
                        Box{{bay_x_m + 0.2, 0.15}, {5, 2}}, Box{{bay_x_m - 0.2, 0.5}, {bay_x_m + 0.2, 2}}});
}

OtherRobot oncoming_robot(double x_m, double goal_x_m) {
  return {7, true, {x_m, 0}, {Vec2(goal_x_m, 0), Vec2(goal_x_m, 0)}, true};
}

struct Robot {
  Robot() : give_way(GiveWayFloor{kField, kRadius_m, kRequired_m, kSeparation_m}, GiveWaySettings{}) {}

  GiveWay give_way;
  Rng rng{1};
  double decided_s = 0;

  std::optional<Vec2> home_m{};  // where the robot comes back to

  /// Decides ten times per second until this time. Returns the place to give way, if any.
  std::optional<Vec2> decide(double seconds, const Vec2& position_m, const std::vector<OtherRobot>& others,
                             const ObstacleWorld& fixed) {
    for (; decided_s < seconds + 1e-6; decided_s += 0.1) decide_once(decided_s, position_m, others, fixed);
    return give_way.place_m();
  }
  /// Decides until it chooses a place, at most until this time.
  std::optional<Vec2> first_place_m(double until_s, const Vec2& position_m,
                                    const std::vector<OtherRobot>& others, const ObstacleWorld& fixed) {
    for (; decided_s < until_s && !give_way.place_m(); decided_s += 0.1)
      decide_once(decided_s, position_m, others, fixed);
    return give_way.place_m();
  }
  std::optional<Vec2> decide_once(double seconds, const Vec2& position_m,
                                  const std::vector<OtherRobot>& others, const ObstacleWorld& fixed) {
    if (give_way.track_progress(at(seconds), 5 - position_m.x()) && !give_way.is_searching())
      give_way.begin_search(at(seconds), position_m, others, fixed, home_m);
    while (give_way.is_searching()) give_way.search(at(seconds), rng);
    return give_way.place_m();
  }
};

TEST_CASE("a robot that is stuck in a corridor backs into the nearest bay until the other robot has passed") {
  const double bay_x_m = GENERATE(-3.0, -1.5, -0.6, 1.4);
  CAPTURE(bay_x_m);
  const ObstacleWorld fixed = corridor(bay_x_m);
  Robot robot;
  // A bay behind the other robot is unreachable.
  const bool is_reachable = bay_x_m < 0;
  const std::vector<OtherRobot> facing{oncoming_robot(0.2, -4.9)};
  CHECK_FALSE(robot.decide(0, {0, 0}, facing, fixed));
  CHECK_FALSE(robot.decide(1.4, {0, 0}, facing, fixed));
  std::optional<Vec2> place;
  for (double t = 1.6; t < 6 && !place; t += 0.1) place = robot.decide(t, {0, 0}, facing, fixed);
  REQUIRE(place.has_value() == is_reachable);
  CHECK(robot.give_way.waits_for().has_value() == is_reachable);
  if (!is_reachable) return;
  CHECK(robot.give_way.waits_for()->first == 7);
  CHECK(robot.give_way.waits_for()->second == Vec2(0.2, 0));
  CHECK(std::abs(place->x() - bay_x_m) < 0.2);
  CHECK(place->y() >= kSeparation_m);
  CHECK_FALSE(fixed.touches(*place, kRequired_m));
  // The robot stays while the other robot is on its way, and continues once it has passed.
  CHECK(robot.decide(7, *place, {oncoming_robot(bay_x_m + 0.5, -4.9)}, fixed) == place);
  CHECK_FALSE(robot.decide(8, *place, {oncoming_robot(bay_x_m - 0.5, -4.9)}, fixed));
  CHECK_FALSE(robot.give_way.waits_for());
}

TEST_CASE("a robot gives way only if it is stuck and blocks a robot with the right of way") {
  const ObstacleWorld fixed = corridor(-1);
  SECTION("the robot makes progress") {
    Robot robot;
    for (int i = 0; i < 50; ++i)
      CHECK_FALSE(robot.decide(0.1 * i, {-4 + 0.02 * i, 0}, {oncoming_robot(0.2, -4.9)}, fixed));
  }
  SECTION("the other robot must give way") {
    Robot robot;
    OtherRobot other = oncoming_robot(0.2, -4.9);
    other.has_right_of_way = false;
    for (int i = 0; i < 50; ++i) CHECK_FALSE(robot.decide(0.1 * i, {0, 0}, {other}, fixed));
  }
  SECTION("the other robot drives away or stays at rest") {
    Robot robot;
    for (int i = 0; i < 50; ++i) CHECK_FALSE(robot.decide(0.1 * i, {0, 0}, {oncoming_robot(0.2, 4)}, fixed));
    for (int i = 50; i < 99; ++i)
      CHECK_FALSE(robot.decide(0.1 * i, {0, 0}, {oncoming_robot(0.2, 0.2)}, fixed));
  }
}

TEST_CASE("a robot that gives way continues after a while if no robot passes") {
  const ObstacleWorld fixed = corridor(-1);
  Robot robot;
  const std::vector<OtherRobot> facing{oncoming_robot(0.2, -4.9)};
  CHECK_FALSE(robot.decide(0, {0, 0}, facing, fixed));
  const std::optional<Vec2> place = robot.decide(2, {0, 0}, facing, fixed);
  REQUIRE(place);
  CHECK(robot.decide(15, *place, facing, fixed) == place);
  CHECK_FALSE(robot.decide(23, *place, facing, fixed));
}

TEST_CASE("a robot that gets a new goal stops giving way") {
  const ObstacleWorld fixed = corridor(-1);
  Robot robot;
  const std::vector<OtherRobot> facing{oncoming_robot(0.2, -4.9)};
  CHECK_FALSE(robot.decide(0, {0, 0}, facing, fixed));
  REQUIRE(robot.decide(2, {0, 0}, facing, fixed));
  robot.give_way.restart(at(2.1));
  CHECK_FALSE(robot.give_way.place_m());
}

TEST_CASE("a robot does not choose a place that another robot occupies") {
  // Another robot occupies the bay, and a third one blocks the way back.
  const ObstacleWorld fixed = corridor(-1);
  Robot robot;
  OtherRobot in_bay{1, true, {-1, 0.3}}, behind{2, true, {-1.6, 0}};
  const std::vector<OtherRobot> others{oncoming_robot(0.2, -4.9), in_bay, behind};
  for (int i = 0; i < 80; ++i) CHECK_FALSE(robot.decide(0.1 * i, {0, 0}, others, fixed));
}

TEST_CASE("robots that block each other and move back and forth do not count as making progress") {
  const ObstacleWorld fixed = corridor(-1);
  Robot robot;
  const std::vector<OtherRobot> facing{oncoming_robot(0.5, -4.9)};
  std::optional<Vec2> place;
  for (int i = 0; i < 30 && !place; ++i)
    place = robot.decide(0.1 * i, {0.15 * std::sin(0.1 * i * 7), 0}, facing, fixed);
  CHECK(place);
}

TEST_CASE("a robot gives way until the other robot has passed, even while the other robot is far away") {
  const ObstacleWorld fixed = corridor(-1);
  Robot robot;
  (void)robot.decide(2.5, {0, 0}, {oncoming_robot(0.2, -4.9)}, fixed);
  const std::optional<Vec2> place = robot.give_way.place_m();
  REQUIRE(place);
  const auto yields_to = robot.give_way.yields_to();
  REQUIRE(std::vector(yields_to.begin(), yields_to.end()) == std::vector<RobotId>{7});
  OtherRobot far{7, false};
  far.has_right_of_way = GENERATE(false, true);
  CHECK(robot.decide(5, *place, {far}, fixed) == place);
  // Robots that are held or whose orders are over are not listed, so the robot stops giving way.
  CHECK_FALSE(robot.decide(6, *place, {}, fixed));
}

TEST_CASE("a robot that blocks a door only together with another robot gives way") {
  // A wall with a door as wide as two robots. Two robots stand in the door side by side.
  const ObstacleWorld fixed({Box{{-0.05, -2}, {0.05, -0.24}}, Box{{-0.05, 0.24}, {0.05, 2}}});
  const OtherRobot beside{1, true, {0, -0.125}};
  Robot robot;
  std::optional<Vec2> place;
  for (double t = 0; t < 6 && !place; t += 0.1)
    place = robot.decide(t, {0, 0.125}, {oncoming_robot(0.4, -4.9), beside}, fixed);
  CHECK(place);
  Robot alone;
  for (int i = 0; i < 60; ++i)
    CHECK_FALSE(alone.decide(0.1 * i, {0, 0.125}, {oncoming_robot(0.4, -4.9)}, fixed));
}

TEST_CASE("a robot chooses another place if its place is occupied or cannot be reached") {
  // One bay is above the corridor, another one below it.
  const ObstacleWorld fixed({Box{{-5, -2}, {-2.2, -0.15}}, Box{{-1.8, -2}, {5, -0.15}},
                             Box{{-2.2, -2}, {-1.8, -0.5}}, Box{{-5, 0.15}, {-1.2, 2}},
                             Box{{-0.8, 0.15}, {5, 2}}, Box{{-1.2, 0.5}, {-0.8, 2}}});
  Robot robot;
  std::vector<OtherRobot> others{oncoming_robot(0.2, -4.9)};
  (void)robot.decide(2.5, {0, 0}, others, fixed);
  const std::optional<Vec2> first = robot.give_way.place_m();
  REQUIRE(first);
  CHECK(first->y() > 0);
  const bool is_taken = GENERATE(true, false);
  CAPTURE(is_taken);
  if (is_taken) {
    others.push_back({1, true, *first});
    others.back().rests = true;
  }
  std::optional<Vec2> place = first;
  for (double t = 2.6; t < 15 && place && place->y() > 0; t += 0.1)
    place = robot.decide(t, {0, 0}, others, fixed);
  REQUIRE(place);  // until it has found another place, the robot keeps its place
  CHECK(place->y() < 0);
}

TEST_CASE("a robot keeps giving way until the other robot has passed, even if the right of way changes") {
  const ObstacleWorld fixed = corridor(-1);
  Robot robot;
  (void)robot.decide(2.5, {0, 0}, {oncoming_robot(0.2, -4.9)}, fixed);
  const std::optional<Vec2> place = robot.give_way.place_m();
  REQUIRE(place);
  OtherRobot other = oncoming_robot(0.1, -4.9);
  other.has_right_of_way = false;
  CHECK(robot.decide(5, *place, {other}, fixed) == place);
  other.position_m = {-1.5, 0};
  CHECK_FALSE(robot.decide(6, *place, {other}, fixed));
}

TEST_CASE("a search ends when the robot makes progress or gets a new goal") {
  const ObstacleWorld fixed = corridor(-1);
  Robot robot;
  CHECK_FALSE(robot.give_way.track_progress(at(0), 5));
  REQUIRE(robot.give_way.track_progress(at(0.9), 5) == false);
  REQUIRE(robot.give_way.track_progress(at(1.6), 5));
  const std::vector<OtherRobot> facing{oncoming_robot(0.2, -4.9)};
  robot.give_way.begin_search(at(1.6), {0, 0}, facing, fixed);
  CHECK(robot.give_way.is_searching());
  CHECK(robot.give_way.track_progress(at(1.7), 5));
  const bool has_progress = GENERATE(false, true);
  if (has_progress)
    CHECK_FALSE(robot.give_way.track_progress(at(1.8), 4.8));
  else
    robot.give_way.restart(at(1.8));
  CHECK_FALSE(robot.give_way.is_searching());
}

TEST_CASE("a robot does not give way to a robot that can drive around it, nor immediately after a pause") {
  const ObstacleWorld open;
  Robot robot;
  const OtherRobot other = oncoming_robot(1, -4.9);
  for (int i = 0; i < 50; ++i) CHECK_FALSE(robot.decide(0.1 * i, {0, 0}, {other}, open));
  const ObstacleWorld fixed = corridor(-1);
  Robot paused;
  CHECK_FALSE(paused.decide_once(0, {0, 0}, {}, fixed));
  CHECK_FALSE(paused.decide_once(60, {0, 0}, {oncoming_robot(0.2, -4.9)}, fixed));
}

/// A corridor along the x axis, 0.3 m wide, that is closed at x = -1 and leads into the open at x = 1.
ObstacleWorld dead_end() {
  return ObstacleWorld({Box{{-5, -2}, {1, -0.15}}, Box{{-5, 0.15}, {1, 2}}, Box{{-5, -0.15}, {-1, 0.15}}});
}

TEST_CASE("a robot that cannot get out chooses a place behind the robot that waits for it") {
  Robot robot;
  OtherRobot other = oncoming_robot(0.4, -0.8);
  other.rests = true;
  SECTION("the other one waits") {
    other.waits = true;
    const std::optional<Vec2> place = robot.first_place_m(10, {0, 0}, {other}, dead_end());
    REQUIRE(place);
    CHECK(place->x() > 0.4 + kSeparation_m);
  }
  SECTION("the other one does not leave its place") {
    CHECK_FALSE(robot.decide(20, {0, 0}, {other}, dead_end()));
  }
}

TEST_CASE("a robot that comes back chooses a place from which the others do not lock it out") {
  Robot robot;
  OtherRobot other = oncoming_robot(0.4, -0.5);
  other.rests = other.waits = true;
  other.end_m = Vec2(-0.5, 0);
  SECTION("it comes back") {
    robot.home_m = Vec2(0, 0);
    const std::optional<Vec2> place = robot.first_place_m(10, {0, 0}, {other}, dead_end());
    REQUIRE(place);
    CHECK(place->x() > 0.4 + kSeparation_m);
  }
  SECTION("it does not come back") {
    const std::optional<Vec2> place = robot.first_place_m(10, {0, 0}, {other}, dead_end());
    REQUIRE(place);
    CHECK(place->x() < -0.5 - kSeparation_m);
  }
  SECTION("no such place exists: it is locked out rather than in the way") {
    robot.home_m = Vec2(-0.2, 0);
    other.end_m = Vec2(0.3, 0);
    other.goals_m = {Vec2(-0.5, 0), Vec2(-0.5, 0)};
    const ObstacleWorld closed(
        {Box{{-5, -2}, {5, -0.15}}, Box{{-5, 0.15}, {5, 2}}, Box{{-5, -0.15}, {-1, 0.15}}});
    const std::optional<Vec2> place = robot.first_place_m(60, {0, 0}, {other}, closed);
    REQUIRE(place);
    CHECK(place->x() < -0.5 - kSeparation_m);
  }
}

TEST_CASE("a robot at its place chooses another one when the others have to pass there") {
  const ObstacleWorld fixed = corridor(-1);
  Robot robot;
  const std::optional<Vec2> first = robot.decide(2.5, {0, 0}, {oncoming_robot(0.2, -4.9)}, fixed);
  REQUIRE(first);
  // The other one has a goal in the bay now.
  OtherRobot other = oncoming_robot(-0.6, 0);
  other.goals_m = {*first, *first};
  const std::optional<Vec2> second = robot.decide(8, *first, {other}, fixed);
  REQUIRE(second);
  CHECK((*second - *first).norm() >= kSeparation_m);
}

TEST_CASE("a robot whose place is taken waits where it is in nobody's way, and continues in the end") {
  const ObstacleWorld fixed = corridor(-1);
  Robot robot;
  const std::optional<Vec2> first = robot.decide(2.5, {0, 0}, {oncoming_robot(0.2, -4.9)}, fixed);
  REQUIRE(first);
  // It is beside its place now. Another robot has come to rest there.
  OtherRobot taker{1, true, *first + Vec2(0.12, 0)};
  taker.rests = true;
  const Vec2 here = *first - Vec2(0.08, 0);
  for (const double x_m : {0.2, -0.1}) {
    CAPTURE(x_m);
    const std::optional<Vec2> place = robot.decide(4 - x_m, here, {oncoming_robot(x_m, -4.9), taker}, fixed);
    REQUIRE(place);
    CHECK((*place - here).norm() < 0.05);
  }
  CHECK_FALSE(robot.decide(8, here, {oncoming_robot(-2, -4.9), taker}, fixed));
}

TEST_CASE("a robot makes room for one that is a few centimetres from its goal") {
  const ObstacleWorld open;
  Robot robot;
  // It rests 7 cm from the goal of the other one, which is as near to it as possible.
  OtherRobot other = oncoming_robot(0.2, 0);
  other.goals_m = {Vec2(0.2, 0), Vec2(0.15, 0)};
  const std::optional<Vec2> place = robot.first_place_m(4, {0, 0}, {other}, open);
  REQUIRE(place);
  CHECK((*place - Vec2(0.15, 0)).norm() >= kSeparation_m);
}

}  // namespace sidestep::give_way_test
