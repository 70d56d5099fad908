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
    return BeamPlanner(problem).plan(query, rng);
  }
  double straight_s() const {
    return to_seconds(leg_times((query.goal_m - query.start_m).norm(), query.limits).total());
  }

  ObstacleWorld world{{Box{{-0.05, -1}, {0.05, -0.16}}, Box{{-0.05, 0.16}, {0.05, 1}}}};
  JointProblem problem;
  BeamQuery query;
  std::vector<const SampledCourse*> others;
};

TEST_CASE("a robot waits at a door until another one has come through") {
  DoorFloor floor;
  BeamQuery opposite = floor.query;
  opposite.start_m = {0.6, 0.1};
  opposite.goal_m = {-0.9, 0.6};
  Rng rng(1);
  const auto other = BeamPlanner(floor.problem).plan(opposite, rng);
  REQUIRE(other);
  floor.others = {&*other};
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
  floor.others = {&resting};
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

TEST_CASE("robots can rest only where they touch neither each other nor obstacles") {
  const DoorFloor floor;
  const BeamPlanner planner(floor.problem);
  CHECK(planner.can_rest_at(std::vector<Vec2>{{-1, 0}, {-1, 0.25}, {0, 0}}));
  CHECK_FALSE(planner.can_rest_at(std::vector<Vec2>{{-1, 0}, {-1, 0.19}}));
  CHECK_FALSE(planner.can_rest_at(std::vector<Vec2>{{-1, 0}, {0, 0.1}}));
  CHECK_FALSE(planner.can_rest_at(std::vector<Vec2>{{1.95, 0}}));
}

}  // namespace sidestep::beam_planner_test
