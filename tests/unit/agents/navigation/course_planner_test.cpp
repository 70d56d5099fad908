// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/course_planner.hpp"

#include <cmath>
#include <numbers>

#include "tests/catch.hpp"
#include "tests/unit/agents/navigation/course_crowd.hpp"
#include "tests/unit/agents/navigation/driving_courses.hpp"

namespace sidestep::course_planner_test {

using namespace std::chrono_literals;

constexpr Duration kCycle = CourseCrowd::kCycle;
constexpr Time kStart = CourseCrowd::kStart;

/// A robot at rest at (-2, 0) that drives to (2, 0).
CoursePlanner::Query drive_across() {
  CoursePlanner::Query query;
  query.start = kStart;
  query.at_start.position_m = {-2, 0};
  query.target_m = {2, 0};
  query.goal_m = query.target_m;
  return query;
}

TEST_CASE("a robot alone drives straight, and as fast as it may") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const Vec2 from_m = random_vector(rng, 2.5), to_m = random_vector(rng, 2.5);
    CourseCrowd crowd;
    CrowdRobot& robot = crowd.add(from_m, to_m);
    const double alone_s = time_alone_s(from_m, to_m);
    const Vec2 across = left_of((to_m - from_m).normalized());
    for (int cycle = 0; cycle < 300 && !robot.arrived_at; ++cycle) {
      crowd.step();
      CHECK(std::abs((robot.state.position_m - from_m).dot(across)) < 0.001);
    }
    REQUIRE(robot.arrived_at);
    // One cycle passes until it has a course.
    CHECK(driven_s(robot) <= 1.05 * alone_s + 2 * to_seconds(kCycle));
    CHECK(robot.plans == 1);
    CHECK(crowd.offers_made == 0);
  }
}

TEST_CASE("a robot alone does not overshoot its target") {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const double length_m = rng.uniform(0.3, 5);
    CourseCrowd crowd;
    CrowdRobot& robot = crowd.add({-2.5, 0}, {-2.5 + length_m, 0});
    double farthest_m = 0;
    for (int cycle = 0; cycle < 300 && !robot.arrived_at; ++cycle) {
      crowd.step();
      farthest_m = std::max(farthest_m, robot.state.position_m.x() + 2.5 - length_m);
    }
    CHECK(farthest_m < 0.0005);
  }
}

TEST_CASE("a robot that is held at its start delays its course and publishes the delay") {
  CourseCrowd crowd;
  CrowdRobot& robot = crowd.add({-2, 0}, {2, 0});
  crowd.step();
  const DrivingCourse before = robot.published.value();
  robot.is_held = true;
  crowd.run_for(100ms);
  robot.is_held = false;
  crowd.run_for(100ms);
  const DrivingCourse after = robot.published.value();
  CHECK(after.planned_at == before.planned_at);
  CHECK(to_seconds(after.start - before.start) == Approx(0.1).margin(0.02));
  CHECK((after.state_at(crowd.now).position_m - robot.state.position_m).norm() < 0.01);
  CHECK(crowd.run(5s));
  CHECK(robot.plans == 1);
  CHECK(driven_s(robot) < time_alone_s({-2, 0}, {2, 0}) + 0.25);
}

TEST_CASE("a robot that has to brake for a moment delays its course and publishes the delay") {
  CourseCrowd crowd;
  CrowdRobot& robot = crowd.add({-2, 0}, {2, 0});
  crowd.run_for(1s);
  const DrivingCourse before = robot.published.value();
  robot.is_held = true;
  crowd.run_for(100ms);
  robot.is_held = false;
  crowd.run_for(300ms);
  const DrivingCourse after = robot.published.value();
  CHECK(after.planned_at == before.planned_at);
  CHECK(after.start > before.start + 10ms);
  CHECK(after.start < before.start + 100ms);
  CHECK((after.state_at(crowd.now).position_m - robot.state.position_m).norm() < 0.02);
  CHECK(crowd.run(5s));
}

TEST_CASE("a robot that is held for longer plans another course when it may drive again") {
  CourseCrowd crowd;
  CrowdRobot& robot = crowd.add({-2, 0}, {2, 0});
  crowd.run_for(1s);
  const Time before = robot.published.value().planned_at;
  robot.is_held = true;
  crowd.run_for(1s);
  robot.is_held = false;
  crowd.run_for(100ms);
  CHECK(robot.published.value().planned_at != before);
  CHECK(crowd.run(5s));
}

TEST_CASE("a robot that is pushed aside plans another course, and does not follow the old one any more") {
  CourseCrowd crowd;
  CrowdRobot& robot = crowd.add({-2, 0}, {2, 0});
  crowd.run_for(1s);
  const DrivingCourse before = robot.published.value();
  robot.state.position_m.y() += 0.1;
  crowd.step();
  CHECK_FALSE(robot.followed);
  REQUIRE(robot.published);
  CHECK(robot.published->planned_at == crowd.now);
  CHECK(robot.published->due == before.due);
  crowd.step();
  CHECK(robot.followed == robot.published->planned_at);
  CHECK(crowd.run(5s));
}

TEST_CASE("a robot that gives up its course has none, and plans another one later") {
  CourseCrowd crowd;
  CrowdRobot& robot = crowd.add({-2, 0}, {2, 0});
  crowd.run_for(500ms);
  REQUIRE(robot.planner.course());
  robot.planner.give_up();
  CHECK_FALSE(robot.planner.course());
  CHECK(robot.planner.offers().empty());
  crowd.step();
  CHECK_FALSE(robot.followed);
  crowd.step();
  CHECK(robot.followed == crowd.now - kCycle);
  CHECK(crowd.run(5s));
}

TEST_CASE("a robot with another target is due at another time") {
  CourseCrowd crowd;
  CrowdRobot& robot = crowd.add({-2, 0}, {2, 0});
  crowd.run_for(500ms);
  const Time due = robot.published.value().due;
  CHECK(to_seconds(due - kStart) == Approx(time_alone_s({-2, 0}, {2, 0})).margin(1e-6));
  robot.target_m = {-2, 2};
  const Vec2 from_m = robot.state.position_m;
  const Time changed = crowd.now;
  crowd.run_for(100ms);
  CHECK(to_seconds(robot.published.value().due - changed) ==
        Approx(time_alone_s(from_m, {-2, 2})).margin(1e-6));
  CHECK((robot.published.value().goal_m() - Vec2(-2, 2)).norm() < 1e-6);
  CHECK(crowd.run(5s));
}

TEST_CASE("a robot drives around a robot that stays on its way") {
  CourseCrowd crowd;
  crowd.staying_m = {{0, 0.02}};
  CrowdRobot& robot = crowd.add({-2, 0}, {2, 0});
  CHECK(crowd.run(6s));
  CHECK(crowd.nearest_m >= crowd.rules.min_separation_m());
  CHECK(driven_s(robot) < time_alone_s({-2, 0}, {2, 0}) + 0.4);
}

//  +-----o-----+
//  |     o     |
//  |  a  o     |   Robots that stay close the floor.
//  |     o     |
//  +-----o-----+
TEST_CASE("a robot whose way is closed has no course, and tries again after a fifth of a second") {
  CourseCrowd crowd({6, 2});
  for (int i = -3; i <= 3; ++i) crowd.staying_m.push_back({0, 0.3 * i});
  CrowdRobot& robot = crowd.add({-2, 0}, {2, 0});
  crowd.step();
  CHECK_FALSE(robot.published);
  const Time tried = crowd.now;  // for the cycle from here on
  crowd.staying_m.clear();
  while (!robot.published && crowd.now < tried + 1s) crowd.step();
  REQUIRE(robot.published);
  CHECK(robot.published->planned_at >= tried + 200ms);
  CHECK(robot.published->planned_at <= tried + 200ms + kCycle);
  CHECK(crowd.run(5s));
}

TEST_CASE("a robot does not drive where its way is closed for good") {
  CourseCrowd crowd({6, 2});
  for (int i = -3; i <= 3; ++i) crowd.staying_m.push_back({0, 0.3 * i});
  CrowdRobot& robot = crowd.add({-2, 0}, {2, 0});
  crowd.run_for(2s);
  CHECK_FALSE(robot.published);
  CHECK(robot.state.position_m == Vec2(-2, 0));
}

TEST_CASE("what is planned in a cycle is followed from the next cycle on") {
  FloorRules rules;
  CoursePlanner planner(1, rules, ObstacleWorld());
  Rng rng(1);
  CoursePlanner::Query query = drive_across();
  CHECK_FALSE(planner.follow(query));
  CHECK_FALSE(planner.course());
  query.start += kCycle;
  planner.plan(query, rng);
  REQUIRE(planner.course());
  const Time first = planner.course()->planned_at;
  CHECK(planner.course()->start == query.start);
  // Another robot's course, which precedes, comes too close at once.
  DrivingCourse other = direct_course(0, kStart - 1s, {{-2, -0.5}, {0, 0}}, {0, 0});
  other.start = kStart;
  const std::vector<const DrivingCourse*> others{&other};
  query.around.others = others;
  for (int cycle = 0; cycle < 100; ++cycle) {
    const DrivingCourse* followed = planner.follow(query);
    REQUIRE(followed);
    CHECK(followed->planned_at == first);
    const Vec2 acceleration = planner.acceleration_mps2(query, kCycle);
    query.at_start = state_after(query.at_start, acceleration, to_seconds(kCycle));
    query.start += kCycle;
    planner.plan(query, rng);
    if (!planner.course() || planner.course()->planned_at != first) break;
  }
  REQUIRE(planner.course());
  CHECK(planner.course()->planned_at == query.start);
  const DrivingCourse* followed = planner.follow(query);
  REQUIRE(followed);
  CHECK(followed->planned_at == query.start);
}

TEST_CASE("a robot without a goal for its course gives its course up, searches for none, and stays due") {
  FloorRules rules;
  CoursePlanner planner(1, rules, ObstacleWorld());
  Rng rng(1);
  CoursePlanner::Query query = drive_across();
  planner.follow(query);
  planner.plan(query, rng);
  REQUIRE(planner.course());
  const Time due = planner.course()->due;
  query.goal_m.reset();
  query.start += kCycle;
  CHECK_FALSE(planner.follow(query));
  CHECK_FALSE(planner.course());
  planner.plan(query, rng);
  CHECK_FALSE(planner.course());
  query.goal_m = query.target_m;
  query.start += kCycle;
  planner.follow(query);
  planner.plan(query, rng);
  REQUIRE(planner.course());
  CHECK(planner.course()->due == due);
}

//  start    o    ...    target     The course around a robot ends three metres ahead, and is continued.
TEST_CASE("on a large floor, a robot continues its course until it arrives") {
  CourseCrowd crowd({40, 8});
  crowd.staying_m = {{-6.5, 0.01}, {-2, 0.01}, {3, -0.01}};
  CrowdRobot& robot = crowd.add({-8, 0}, {6, 0});
  crowd.step();
  REQUIRE(robot.published);
  CHECK(robot.published->continues);
  CHECK((robot.published->goal_m() - Vec2(-3, 0)).norm() < 1e-6);
  CHECK(crowd.run(20s));
  CHECK(crowd.nearest_m >= crowd.rules.min_separation_m() - 0.001);
  if (robot.arrived_at) CHECK(driven_s(robot) < time_alone_s({-8, 0}, {6, 0}) + 1.5);
}

/// Robots that stay in a ring around a place. Its gaps look open on the grid of the estimates, but are too
/// narrow.
void add_ring(CourseCrowd& crowd, const Vec2& centre_m) {
  const double turn_rad = std::numbers::pi / 4, gap_m = 2 * (crowd.rules.min_separation_m() - 0.01);
  for (int i = 0; i < 8; ++i)
    crowd.staying_m.push_back(centre_m +
                              rotated(Vec2(gap_m / (2 * std::sin(turn_rad / 2)), 0), i * turn_rad));
}

TEST_CASE("searches without success take no more effort than a robot may spend") {
  CourseCrowd crowd;
  const Vec2 target_m(1.5, 0);
  add_ring(crowd, target_m);
  CrowdRobot& robot = crowd.add({-2, 0}, target_m);
  const int seconds = 10;
  for (int i = 0; i < 10 * seconds; ++i) {
    // The robot tries at once for each other target.
    robot.target_m = target_m + Vec2(i % 2 == 0 ? 0.015 : -0.015, 0);
    crowd.run_for(100ms);
  }
  CHECK_FALSE(robot.published);
  const auto effort = static_cast<double>(robot.planner.effort());
  const double most_of_search = 3 * 2'000 + 500;
  CHECK(effort > 10'000 + 900 * seconds);
  CHECK(effort < 10'000 + 1'000 * seconds + most_of_search);
}

TEST_CASE("a robot whose searches have taken too long gives up its course when something comes near") {
  const Duration taken = GENERATE(Duration{0}, Duration{100us}, Duration{1s});
  CAPTURE(to_seconds(taken));
  FloorRules rules;
  CoursePlanner planner(1, rules, ObstacleWorld());
  Rng rng(1);
  CoursePlanner::Query query = drive_across();
  planner.follow(query);
  planner.plan(query, rng);
  REQUIRE(planner.course());
  const Time first = planner.course()->planned_at;
  planner.charge(taken);
  const std::size_t effort = planner.effort();
  const std::vector<Vec2> staying_m{{-1.6, 0}};
  query.around.staying_m = staying_m;
  for (int cycle = 0; cycle < 20 && planner.course() && planner.course()->planned_at == first; ++cycle) {
    REQUIRE(planner.follow(query));
    query.at_start =
        state_after(query.at_start, planner.acceleration_mps2(query, kCycle), to_seconds(kCycle));
    query.start += kCycle;
    planner.plan(query, rng);
  }
  const bool may_search = taken < 1s;
  CHECK((planner.course() != nullptr) == may_search);
  CHECK((planner.effort() > effort) == may_search);
}

TEST_CASE("a robot that loses its courses at one place drives without one for longer and longer") {
  CourseCrowd crowd;
  CrowdRobot& robot = crowd.add({-2, 0}, {2, 0});
  robot.is_held = true;
  crowd.run_for(10s);
  // A course is lost after 0.3 s. Without pauses there would be thirty.
  CHECK(robot.plans >= 4);
  CHECK(robot.plans <= 9);
  robot.is_held = false;
  CHECK(crowd.run(12s));
}

TEST_CASE("a robot plans another course if a robot without one comes to rest on its way") {
  CourseCrowd crowd;
  CrowdRobot& robot = crowd.add({-2, 0}, {2, 0});
  crowd.run_for(500ms);
  const Time before = robot.published.value().planned_at;
  crowd.staying_m = {{1, 0.01}};
  crowd.run_for(300ms);
  CHECK(robot.published.value().planned_at > before);
  CHECK(crowd.run(5s));
  CHECK(crowd.nearest_m >= crowd.rules.min_separation_m() - 0.001);
}

TEST_CASE("a robot whose target moves by a centimetre keeps its course and arrives at the target") {
  CourseCrowd crowd;
  CrowdRobot& robot = crowd.add({-2, 0}, {2, 0});
  crowd.run_for(500ms);
  const Time before = robot.published.value().planned_at;
  robot.target_m = {2, 0.01};
  crowd.run_for(100ms);
  CHECK(robot.published.value().planned_at == before);
  CHECK(crowd.run(5s));
}

TEST_CASE("a robot is due when it would arrive at the floor's speed limit, however slow it may be at first") {
  CourseCrowd crowd;
  CrowdRobot& robot = crowd.add({-2, 0}, {2, 0});
  robot.limits.speed_mps = 0.3;
  crowd.run_for(100ms);
  const double due_s = to_seconds(robot.published.value().due - kStart);
  CHECK(due_s == Approx(time_alone_s({-2, 0}, {2, 0})).margin(0.05));
}

TEST_CASE("a robot that may drive faster than when it planned its course does so") {
  CourseCrowd crowd;
  CrowdRobot& robot = crowd.add({-2, 0}, {2, 0});
  robot.limits.speed_mps = 0.2;
  crowd.run_for(500ms);
  robot.limits.speed_mps = 2;
  CHECK(crowd.run(6s));
}

TEST_CASE("a robot that must not drive for a moment drives on afterwards") {
  CourseCrowd crowd;
  CrowdRobot& robot = crowd.add({-2, 0}, {2, 0});
  robot.limits.speed_mps = 0;
  crowd.run_for(100ms);
  robot.limits.speed_mps = 2;
  CHECK(crowd.run(6s));
}

}  // namespace sidestep::course_planner_test
