// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include "agents/navigation/course_planner.hpp"
#include "tests/catch.hpp"
#include "tests/unit/agents/navigation/course_crowd.hpp"
#include "tests/unit/agents/navigation/driving_courses.hpp"

namespace sidestep::course_planner_crowd_test {

using namespace std::chrono_literals;

constexpr Duration kCycle = CourseCrowd::kCycle;

//  a -->      <-- b
TEST_CASE("two robots that meet head on pass each other at the required distance, and both arrive") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const double x = rng.uniform(0.8, 2.5), a = rng.uniform(-0.1, 0.1), b = rng.uniform(-0.1, 0.1);
    CourseCrowd crowd;
    crowd.add({-x, a}, {x, b});
    crowd.add({x, b}, {-x, a});
    for (CrowdRobot& robot : crowd.robots) robot.rng = rng.fork();
    CHECK(crowd.run(8s));
    CHECK(crowd.nearest_m >= crowd.rules.min_separation_m());
    for (const CrowdRobot& robot : crowd.robots)
      if (robot.arrived_at) CHECK(driven_s(robot) < time_alone_s({-x, a}, {x, b}) + 1);
  }
}

TEST_CASE("six robots that cross a circle all arrive and keep their distances") {
  const std::uint64_t seed = GENERATE(range(1u, 21u));
  CAPTURE(seed);
  Rng rng(seed);
  CourseCrowd crowd;
  for (int i = 0; i < 6; ++i) {
    const double angle_rad = (i + rng.uniform(-0.2, 0.2)) * std::numbers::pi / 3;
    const Vec2 from_m = rotated({1.5, 0}, angle_rad), to_m = -from_m + random_vector(rng, 0.1);
    crowd.add(from_m, to_m).rng = rng.fork();
  }
  CHECK(crowd.run(15s));
  CHECK(crowd.nearest_m >= crowd.rules.min_separation_m() - 0.001);
}

//                  ^
//                  |
//  far ------------+------------>
//                  |
//                near      The near one sets out later, and they meet.
TEST_CASE("a robot that is due earlier drives as if it were alone, though another has planned before it") {
  CourseCrowd crowd;
  CrowdRobot& far = crowd.add({-2.5, 0}, {2.5, 0});
  crowd.run_for(750ms);
  const Time set_out = crowd.now;
  CrowdRobot& near = crowd.add({0, -1}, {0, 1});
  crowd.step();
  REQUIRE(far.published);
  REQUIRE(near.published);
  REQUIRE(CourseConflicts(crowd.rules.min_separation_m())
              .first_after(*far.published, *near.published, crowd.now));
  for (const Time end = crowd.now + 5s; crowd.now < end && !near.arrived_at;) {
    crowd.step();
    CHECK(std::abs(near.state.position_m.x()) < 0.001);
  }
  REQUIRE(near.arrived_at);
  const double alone_s = time_alone_s({0, -1}, {0, 1});
  CHECK(to_seconds(*near.arrived_at - set_out) <= 1.05 * alone_s + 2 * to_seconds(kCycle));
  CHECK(near.plans == 1);
  CHECK(far.plans > 1);
  CHECK(crowd.run(5s));
  CHECK(crowd.nearest_m >= crowd.rules.min_separation_m() - 0.001);
}

/// A robot that has been driving to (2, 0) for a while, and an offer that fits, by a robot that precedes it.
struct OfferScene {
  OfferScene() {
    robot = &crowd.add({-2, 0}, {2, 0});
    crowd.run_for(600ms);
    present = robot->planner.course()->planned_at;
    const Time start = crowd.now + 3 * kCycle;
    offer.course = direct_course(robot->id, start, robot->planner.course()->state_at(start), {2, 0});
    offer.course.due = robot->planner.course()->due;
    offer.replaces = present;
    DrivingCourse leader = direct_course(7, crowd.now, {{-2.5, 2.5}, {0, 0}}, {-2, 2.5});
    leader.due = offer.course.due - 1s;
    crowd.strangers.push_back(leader);
    offer.by = leader.robot;
  }
  /// The course that the robot has while the offer is recent.
  std::optional<Time> course_after_offer() {
    crowd.offers.push_back({offer, crowd.now});
    crowd.run_for(150ms);
    return robot->followed;
  }

  /// Whether the robot follows the offered course.
  bool has_taken_offer() const {
    const DrivingCourse& course = robot->published.value();
    return course.start == offer.course.start && course.states.size() == offer.course.states.size();
  }

  CourseCrowd crowd;
  CrowdRobot* robot;
  Time present;
  CourseOffer offer;
};

TEST_CASE("a robot takes an offer that fits as soon as the offered course starts") {
  OfferScene scene;
  scene.crowd.offers.push_back({scene.offer, scene.crowd.now});
  for (int cycle = 0; cycle < 3; ++cycle) {
    scene.crowd.step();
    CHECK(scene.robot->followed == scene.present);
  }
  scene.crowd.step();
  CHECK(scene.robot->followed != scene.present);
  CHECK(scene.has_taken_offer());
  CHECK(scene.crowd.run(5s));
}

TEST_CASE("a robot that takes an offer is due when it was due before") {
  OfferScene scene;
  const Time due = scene.robot->published.value().due;
  scene.offer.course.due += 7s;
  CHECK(scene.course_after_offer() != scene.present);
  CHECK(scene.has_taken_offer());
  CHECK(scene.robot->published.value().due == due);
}

TEST_CASE("a robot refuses an offer of a robot that does not precede it, or whose course it does not know") {
  OfferScene scene;
  const bool is_known = GENERATE(false, true);
  CAPTURE(is_known);
  if (is_known)
    scene.crowd.strangers.back().due = scene.offer.course.due + 1s;
  else
    scene.crowd.strangers.clear();
  CHECK(scene.course_after_offer() == scene.present);
}

TEST_CASE("a robot refuses an offer that would delay it for more than four seconds") {
  OfferScene scene;
  std::vector<State>& states = scene.offer.course.states;
  const State first = states.front();
  states.insert(states.begin(), 100, first);
  CHECK(scene.course_after_offer() == scene.present);
}

TEST_CASE("a robot refuses an offer that starts elsewhere") {
  OfferScene scene;
  for (State& state : scene.offer.course.states) state.position_m.y() += 0.2;
  scene.offer.course.states.back().position_m.y() -= 0.2;
  CHECK(scene.course_after_offer() == scene.present);
}

TEST_CASE("a robot refuses an offer to replace another course") {
  OfferScene scene;
  scene.offer.replaces -= 1ns;
  CHECK(scene.course_after_offer() == scene.present);
}

TEST_CASE("a robot refuses an offer that leads to another goal") {
  OfferScene scene;
  scene.offer.course.states.back().position_m.y() += 0.1;
  CHECK(scene.course_after_offer() == scene.present);
}

TEST_CASE("a robot refuses an offer whose course would be continued elsewhere") {
  OfferScene scene;
  scene.offer.course.continues = true;
  CHECK(scene.course_after_offer() == scene.present);
}

TEST_CASE("a robot refuses an offer to another robot") {
  OfferScene scene;
  scene.offer.course.robot = 5;
  CHECK(scene.course_after_offer() == scene.present);
}

TEST_CASE("a robot does not change its course for robots that it precedes") {
  CourseCrowd crowd;
  CrowdRobot& robot = crowd.add({-2, 0}, {2, 0});
  crowd.step();
  const Time planned = robot.published.value().planned_at;
  DrivingCourse stranger = direct_course(9, crowd.now, {{0, -2}, {0, 0}}, {0, 2});
  stranger.due += 1s;
  crowd.strangers = {stranger};
  crowd.run_for(500ms);
  CHECK(robot.published.value().planned_at == planned);
  // It offers the other robot a course instead.
  CHECK(crowd.offers_made > 0);
}

TEST_CASE("a robot that gets no offer soon plans another course around one that precedes its own") {
  CourseCrowd crowd;
  CrowdRobot& robot = crowd.add({-2, 0}, {2, 0});
  crowd.step();
  const Time planned = robot.published.value().planned_at;
  DrivingCourse stranger = direct_course(9, crowd.now, {{0, -2}, {0, 0}}, {0, 2});
  stranger.due -= 1s;
  crowd.strangers = {stranger};
  crowd.run_for(80ms);
  CHECK(robot.published.value().planned_at == planned);
  crowd.run_for(120ms);
  CHECK(robot.published.value().planned_at > planned);
  for (Time end = crowd.now + 5s; crowd.now < end && !robot.arrived_at;) {
    crowd.step();
    CHECK((robot.state.position_m - stranger.state_at(crowd.now).position_m).norm() >=
          crowd.rules.min_separation_m() - 0.004);
  }
  CHECK(robot.arrived_at);
}

/// The course of a robot that comes from the right, and is at a place at the same time as another robot.
DrivingCourse crossing(const DrivingCourse& course, const Vec2& place_m) {
  DrivingCourse crossing = course;
  crossing.robot = 9;
  crossing.due -= 1h;
  for (State& state : crossing.states)
    state = {place_m + left_of(state.position_m - place_m), left_of(state.velocity_mps)};
  return crossing;
}

TEST_CASE("a robot whose clock was set back waits no longer for offers than others") {
  const bool is_set_back = GENERATE(false, true);
  CAPTURE(is_set_back);
  CourseCrowd crowd;
  CrowdRobot& robot = crowd.add({-2.5, 0}, {2.5, 0});
  crowd.step();
  crowd.strangers = {crossing(*robot.published, {0, 0})};
  crowd.run_for(50ms);
  crowd.strangers.clear();
  if (is_set_back) {
    crowd.now -= 200s;
    robot.planner.give_up();
  }
  crowd.run_for(50ms);
  const DrivingCourse before = robot.published.value();
  crowd.strangers = {crossing(before, {0.5, 0})};
  REQUIRE(CourseConflicts(crowd.rules.min_separation_m()).first_after(crowd.strangers[0], before, crowd.now));
  crowd.run_for(300ms);
  CHECK(robot.published.value().planned_at > before.planned_at);
}

}  // namespace sidestep::course_planner_crowd_test
