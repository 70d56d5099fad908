// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/joint/beam_planner.hpp"

#include "agents/planning/joint/leg.hpp"
#include "tests/catch.hpp"

namespace sidestep::beam_planner_test {

//  +-----------+-----------+
//  |           |           |   A wall with a door for one robot.
//  |  start          goal  |
//  |           |           |
//  +-----------+-----------+
struct DoorFloor {
  DoorFloor() {
    problem.world = &world;
    problem.field = {4, 2};
    query.start_m = {-1, 0};
    query.goal_m = {1, 0};
  }
  std::optional<SampledCourse> plan() {
    query.others = others;
    Rng rng(1);
    return BeamPlanner(problem, settings).plan(query, rng);
  }
  double straight_s() const {
    return to_seconds(leg_times((query.goal_m - query.start_m).norm(), query.limits).total());
  }

  ObstacleWorld world{{Box{{-0.05, -1}, {0.05, -0.16}}, Box{{-0.05, 0.16}, {0.05, 1}}}};
  JointProblem problem;
  BeamQuery query;
  std::vector<TimedPositions> others;
  BeamSettings settings;
};

TEST_CASE("a robot waits at a door until another one has come through") {
  DoorFloor floor;
  BeamQuery opposite = floor.query;
  opposite.start_m = {0.6, 0.1};
  opposite.goal_m = {-0.9, 0.6};
  Rng rng(1);
  const auto other = BeamPlanner(floor.problem).plan(opposite, rng);
  REQUIRE(other);
  floor.others = {other->positions()};
  const auto course = floor.plan();
  REQUIRE(course);
  CHECK(course->arrival_s() > floor.straight_s());
  CHECK(course->arrival_s() < floor.straight_s() + 1);
  for (std::size_t k = 0; k < course->samples_m.size(); ++k)
    CHECK((course->at(k) - other->at(k)).norm() >= floor.problem.min_separation_m());
}

TEST_CASE("the samples of a course are its positions") {
  DoorFloor floor;
  floor.query.start_m = {-1, 0.7};
  const auto course = floor.plan();
  REQUIRE(course);
  for (std::size_t k = 0; k < course->samples_m.size(); ++k) {
    const Time at = Time{} + from_seconds(kCourseSample_s * static_cast<double>(k));
    CHECK((course->course.state_at(at).position_m - course->at(k)).norm() < 1e-6);
  }
  CHECK((course->at(1000) - floor.query.goal_m).norm() < 1e-6);
}

TEST_CASE("a door that stays blocked leaves no course") {
  DoorFloor floor;
  const SampledCourse resting{Course(Time{}, {0, 0}), {{0, 0}}};
  floor.others = {resting.positions()};
  CHECK_FALSE(floor.plan());
}

TEST_CASE("a course that would arrive too late is none") {
  DoorFloor floor;
  floor.query.latest_s = 0.9 * floor.straight_s();
  CHECK_FALSE(floor.plan());
  floor.query.latest_s = 1.1 * floor.straight_s();
  CHECK(floor.plan());
}

TEST_CASE("a robot does not run into robots that have not left their starts yet") {
  DoorFloor floor;
  const std::vector<Vec2> waiting_m{{-0.75, 0}};
  floor.query.waiting_m = waiting_m;
  const auto course = floor.plan();
  REQUIRE(course);
  for (std::size_t k = 0; k <= 6; ++k)
    CHECK((course->at(k) - waiting_m[0]).norm() >= floor.problem.min_separation_m());
}

TEST_CASE("a course continues the motion that the robot has at the start") {
  DoorFloor floor;
  floor.query.start_m = {-1, 0.5};
  floor.query.start_mps = {0, -1.5};
  const auto course = floor.plan();
  REQUIRE(course);
  const State at_start = course->course.state_at(Time{});
  CHECK((at_start.velocity_mps - floor.query.start_mps).norm() < 1e-6);
  // Nobody can turn at once.
  CHECK(course->at(1).y() < 0.45);
  for (std::size_t k = 0; k < course->samples_m.size(); ++k)
    CHECK_FALSE(floor.world.touches(course->at(k), floor.problem.radius_m + floor.problem.margin_m));
}

TEST_CASE("a robot that starts too close to another one comes no closer, and then keeps its distance") {
  DoorFloor floor;
  const double near_m = floor.problem.min_separation_m() - 0.01;
  const std::vector<Vec2> beside_m{{-1, near_m}};
  floor.others = {{beside_m}};
  const auto course = floor.plan();
  REQUIRE(course);
  for (std::size_t k = 0; k < course->samples_m.size(); ++k) {
    CAPTURE(k);
    CHECK((course->at(k) - beside_m[0]).norm() >=
          (k < 12 ? near_m - 0.005 : floor.problem.min_separation_m()));
  }
}

TEST_CASE("a robot whose further way is unknown is avoided only as far as it is known") {
  DoorFloor floor;
  const std::vector<Vec2> in_door_m(21, Vec2(0, 0));
  floor.others = {{in_door_m, false}};
  const auto course = floor.plan();
  REQUIRE(course);
  CHECK(course->arrival_s() > floor.straight_s());
  for (std::size_t k = 0; k < in_door_m.size(); ++k)
    CHECK(course->at(k).norm() >= floor.problem.min_separation_m());
  floor.others = {{in_door_m, true}};
  CHECK_FALSE(floor.plan());
}

TEST_CASE("robots that would brake at once stay apart, if that is asked for") {
  DoorFloor floor;
  floor.problem.field = {6, 3};
  floor.world = ObstacleWorld();
  // Another robot comes towards the robot at full speed.
  std::vector<Vec2> other_m;
  for (int k = 0; k <= 40; ++k) {
    other_m.emplace_back(2 - 0.1 * k, 0);
  }
  floor.others = {{other_m}};
  const double brakes_m = floor.problem.min_separation_m();
  const auto closest_if_braking_m = [&](const SampledCourse& course) {
    const double deceleration_mps2 = floor.query.limits.deceleration_mps2;
    double closest_m = 1e9;
    for (std::size_t k = 2; k < course.samples_m.size() && k < other_m.size(); k += 2) {
      const Time at = Time{} + from_seconds(kCourseSample_s * static_cast<double>(k));
      Trajectory own(at, course.course.state_at(at)),
          other(at, {other_m[k], (other_m[k] - other_m[k - 1]) / kCourseSample_s});
      append_stop(own, deceleration_mps2);
      append_stop(other, deceleration_mps2);
      for (int i = 0; i <= 50; ++i) {
        const Time t = at + from_seconds(0.01 * i);
        closest_m = std::min(closest_m, (own.state_at(t).position_m - other.state_at(t).position_m).norm());
      }
    }
    return closest_m;
  };
  floor.settings.braking_separation_m = brakes_m;
  const auto careful = floor.plan();
  REQUIRE(careful);
  CHECK(closest_if_braking_m(*careful) > brakes_m - 0.02);
}

TEST_CASE("an attempt ends when it has expanded as many states as it may") {
  DoorFloor floor;
  const std::vector<Vec2> in_door_m(30, Vec2(0, 0));
  floor.others = {{in_door_m, false}};
  floor.query.others = floor.others;
  BeamPlanner planner(floor.problem);
  Rng rng(1);
  REQUIRE(planner.plan(floor.query, rng));
  const std::size_t all = planner.expanded();
  floor.query.max_expanded = 500;
  CHECK_FALSE(planner.plan(floor.query, rng));
  CHECK(planner.expanded() - all >= 500);
  CHECK(planner.expanded() - all < 500 + 350);  // the last step may be wider than what was left
  CHECK(all > 1'000);
}

TEST_CASE("there is no search if another robot is at the goal for too long") {
  DoorFloor floor;
  Rng rng(1);
  const std::vector<Vec2> resting(1, {1, 0.1});
  // It leaves the goal after two seconds.
  std::vector<Vec2> leaving(40, {1, 0.1});
  for (int k = 1; k <= 10; ++k) leaving.push_back({1, 0.1 + 0.08 * k});
  BeamPlanner planner(floor.problem);
  const auto plan_among = [&](const std::vector<Vec2>& other_m, double latest_s) {
    const TimedPositions other{other_m};
    floor.query.others = {&other, 1};
    floor.query.latest_s = latest_s;
    return planner.plan(floor.query, rng);
  };
  CHECK_FALSE(plan_among(resting, 15));
  CHECK_FALSE(plan_among(leaving, 1.9));
  CHECK(planner.effort() == 0);
  const auto course = plan_among(leaving, 15);
  REQUIRE(course);
  CHECK(course->arrival_s() > 2);
  CHECK(course->arrival_s() < 2.6);
  CHECK(planner.effort() > 0);
}

TEST_CASE("there is no course to or from a place outside the field") {
  DoorFloor floor;
  const ObstacleWorld nothing;
  floor.problem.world = &nothing;
  Rng rng(1);
  const BeamSettings narrow{12, 5, 3};
  for (const Vec2& outside_m : {Vec2(0, 7), Vec2(0, -7), Vec2(30, 0), Vec2(-30, 20)}) {
    CAPTURE(outside_m.x(), outside_m.y());
    BeamQuery query = floor.query;
    query.goal_m = outside_m;
    CHECK_FALSE(BeamPlanner(floor.problem, narrow).plan(query, rng));
    query = floor.query;
    query.start_m = outside_m;
    CHECK_FALSE(BeamPlanner(floor.problem, narrow).plan(query, rng));
    query.goal_m = outside_m;
    CHECK_FALSE(BeamPlanner(floor.problem, narrow).plan(query, rng));
  }
}

TEST_CASE("the fastest motion is planned if it is free") {
  DoorFloor floor;
  BeamPlanner planner(floor.problem);
  const auto straight = planner.plan_straight(floor.query);
  REQUIRE(straight);
  CHECK(straight->arrival_s() == Approx(floor.straight_s()).margin(1e-6));
  const std::vector<Vec2> in_door_m{{0, 0}};
  floor.others = {{in_door_m}};
  floor.query.others = floor.others;
  CHECK_FALSE(planner.plan_straight(floor.query));
}

TEST_CASE("robots can rest only where they touch neither each other nor obstacles") {
  const DoorFloor floor;
  const BeamPlanner planner(floor.problem);
  CHECK(planner.can_rest_at(std::vector<Vec2>{{-1, 0}, {-1, 0.25}, {0, 0}}));
  CHECK_FALSE(planner.can_rest_at(std::vector<Vec2>{{-1, 0}, {-1, 0.19}}));
  CHECK_FALSE(planner.can_rest_at(std::vector<Vec2>{{-1, 0}, {0, 0.1}}));
  CHECK_FALSE(planner.can_rest_at(std::vector<Vec2>{{1.95, 0}}));
}

}  // namespace sidestep::beam_planner_test
