// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "agents/planning/joint/composite_domain.hpp"
#include "agents/planning/joint/composite_planner.hpp"
#include "agents/planning/joint/space_time_path.hpp"
#include "tests/catch.hpp"
#include "tests/study/joint_planning/joint_check.hpp"
#include "tests/unit/agents/planning/joint/random_course.hpp"

namespace sidestep::joint_domains_test {

struct Floor {
  std::vector<Shape> obstacles;
  ObstacleWorld world;
  JointProblem problem;
};

/// Robots and circles at random positions, which need not be free.
Floor random_floor(Rng& rng, int robots) {
  Floor floor;
  for (int i = 0; i < 3; ++i) floor.obstacles.emplace_back(Circle{random_position(rng, 1.5), 0.2});
  floor.world = ObstacleWorld(floor.obstacles);
  floor.problem.field = {4, 4};
  for (int i = 0; i < robots; ++i) {
    floor.problem.starts_m.push_back(random_position(rng, 1.9));
    floor.problem.goals_m.push_back(random_position(rng, 1.9));
  }
  return floor;
}

TEST_CASE("a composite motion is free exactly if an independent check of its courses finds it free") {
  int free = 0, blocked = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    Floor floor = random_floor(rng, 1 + static_cast<int>(rng.below(4)));
    floor.problem.world = &floor.world;
    const CompositeDomain domain(floor.problem);
    const std::vector<CompositeDomain::State> path{floor.problem.starts_m, floor.problem.goals_m};
    const std::string fault =
        fault_of(floor.problem, floor.obstacles, courses_along(path, floor.problem.limits));
    CAPTURE(fault);
    const bool is_free = domain.check(path[0], path[1]);
    ++(is_free ? free : blocked);
    // The sampled check may miss robots that are too close for less than a millisecond.
    if (is_free)
      CHECK(fault.empty());
    else if (fault.empty())
      CHECK_FALSE([&] {
        JointProblem wider = floor.problem;
        wider.margin_m += 0.01;
        return fault_of(wider, floor.obstacles, courses_along(path, wider.limits)).empty();
      }());
    CHECK(domain.check(path[1], path[0]) == is_free);
  }
  CHECK(free > 30);
  CHECK(blocked > 100);
}

TEST_CASE("an extension of the composite tree is free and brings the tree nearer to its target") {
  int extended = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    Floor floor = random_floor(rng, 4);
    floor.problem.world = &floor.world;
    const CompositeDomain domain(floor.problem);
    const CompositeDomain::State &from = floor.problem.starts_m, to = domain.sample(rng);
    if (!domain.check(from, from)) continue;
    const auto reached = domain.extend(from, to);
    if (!reached) continue;
    ++extended;
    CHECK(domain.check(from, *reached));
    CHECK(domain.distance(*reached, to) < domain.distance(from, to));
  }
  CHECK(extended > 50);
}

TEST_CASE(
    "a motion in space and time is free exactly if an independent check of both courses finds it free") {
  int free = 0, blocked = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    Floor floor = random_floor(rng, 2);
    floor.problem.world = &floor.world;
    // The other robot stays on the floor. It ignores obstacles, so its course is checked without them.
    const std::vector<Course> others{random_course(rng, 2, 1.8)};
    floor.problem.starts_m[1] = others[0].legs().front().at_start().position_m;
    floor.problem.goals_m[1] = others[0].rest_position_m();
    const SpaceTimeDomain domain(floor.problem, 0, others);
    const SpaceTimeState start = domain.start();
    SpaceTimeState arrival = domain.goal(start);
    if (rng.chance(0.5)) arrival.at += from_seconds(rng.uniform(0, 3));
    const std::vector<Course> both{course_along({start, arrival}, floor.problem.limits), others[0]};
    JointProblem alone = floor.problem;
    alone.starts_m.resize(1), alone.goals_m.resize(1);
    const std::string fault_alone = fault_of(alone, floor.obstacles, std::span(both).first(1)),
                      fault_together = fault_of(floor.problem, {}, both);
    CAPTURE(fault_alone, fault_together);
    const bool is_free = domain.check(start, arrival);
    ++(is_free ? free : blocked);
    if (is_free)
      CHECK((fault_alone.empty() && fault_together.empty()));
    else if (fault_alone.empty() && fault_together.empty()) {
      JointProblem wider = floor.problem;
      wider.margin_m += 0.01;
      alone.margin_m += 0.01;
      CHECK_FALSE((fault_of(wider, {}, both).empty() &&
                   fault_of(alone, floor.obstacles, std::span(both).first(1)).empty()));
    }
  }
  CHECK(free > 30);
  CHECK(blocked > 100);
}

TEST_CASE("a state that is too early is unreachable, but its position is reachable") {
  Rng rng(1);
  Floor floor;
  floor.problem.world = &floor.world;
  floor.problem.starts_m = {{-1, 0}};
  floor.problem.goals_m = {{1, 0}};
  const SpaceTimeDomain domain(floor.problem, 0, {});
  const SpaceTimeState early{{1, 1}, Time{} + from_seconds(0.1)};
  CHECK_FALSE(domain.check(domain.start(), early));
  CHECK(domain.distance(domain.start(), early) > 1000);
  const auto reached = domain.extend(domain.start(), early);
  REQUIRE(reached);
  CHECK(reached->at_m == early.at_m);
  CHECK(reached->at == domain.earliest_arrival(domain.start(), early.at_m));
  CHECK(domain.distance(*reached, domain.goal(*reached)) > 0);
  CHECK(domain.distance(domain.goal(*reached), domain.goal(domain.goal(*reached))) == 0);
}

TEST_CASE("shortening keeps a path free and never makes it arrive later") {
  int shorter = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    Floor floor = random_floor(rng, 1);
    floor.problem.world = &floor.world;
    const std::vector<Course> others{random_course(rng, 2, 1.8)};
    const SpaceTimeDomain domain(floor.problem, 0, others);
    // A detour via random states.
    std::vector<SpaceTimeState> path{domain.start()};
    for (int i = 0; i < 40 && path.size() < 6; ++i)
      if (const auto next = domain.extend(path.back(), domain.sample(rng))) path.push_back(*next);
    const SpaceTimeState goal = domain.goal(path.back());
    if (path.size() < 4 || !domain.check(path.back(), goal)) continue;
    path.push_back(goal);
    std::vector<SpaceTimeState> shortened = path;
    shorten(domain, shortened);
    CHECK(shortened.front() == path.front());
    CHECK(shortened.back().at_m == path.back().at_m);
    CHECK(shortened.back().at <= path.back().at);
    shorter += shortened.back().at < path.back().at;
    for (std::size_t i = 1; i < shortened.size(); ++i) CHECK(domain.check(shortened[i - 1], shortened[i]));
  }
  CHECK(shorter > 20);
}

}  // namespace sidestep::joint_domains_test
