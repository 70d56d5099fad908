// SPDX-License-Identifier: Apache-2.0
#include "tests/study/problems/replan_course.hpp"

#include "tests/catch.hpp"

namespace sidestep::replan_course_test {

Vec2 centre_of(const DiscDomain& domain, std::uint32_t circle) {
  return std::get<Circle>(domain.world().shape(ObstacleId{circle})).centre_m;
}

TEST_CASE("on a replan course the robot and the obstacles keep their speeds and stay on the field") {
  const auto seed = GENERATE(1u, 2u);
  CAPTURE(seed);
  ReplanCourse course(400, seed);
  course.step();
  std::vector<Vec2> centres(64);
  Vec2 start = course.start_m();
  double driven_m = 0;
  for (int cycle = 0; cycle < 400; ++cycle) {
    for (std::uint32_t i = 0; i < 64; ++i) centres[i] = centre_of(course.domain(), i);
    course.step();
    const DiscDomain domain = course.domain();
    for (std::uint32_t i = 0; i < 64; ++i) {
      const Vec2 centre = centre_of(domain, i);
      REQUIRE((centre - centres[i]).norm() ==
              Approx(ReplanCourse::kObstacleSpeed_mps * ReplanCourse::kCycle_s));
      REQUIRE(std::max(std::abs(centre.x()), std::abs(centre.y())) < 5.1);
    }
    const double step_m = (course.start_m() - start).norm();
    REQUIRE(step_m < ReplanCourse::kSpeed_mps * ReplanCourse::kCycle_s + 1e-9);
    driven_m += step_m;
    start = course.start_m();
    REQUIRE(course.is_valid(course.shortest().states));
    REQUIRE(course.shortest().states.front() == start);
  }
  CHECK(driven_m > 8);
}

TEST_CASE("a replan course rejects a path that touches a circle") {
  ReplanCourse course(50, 1);
  int crossed = 0;
  for (int cycle = 0; cycle < 50; ++cycle) {
    course.step();
    const DiscDomain domain = course.domain();
    if (domain.start_is_blocked()) continue;
    for (std::uint32_t i = 0; i < 64; ++i, ++crossed)
      REQUIRE_FALSE(course.is_valid({course.start_m(), centre_of(domain, i)}));
  }
  CHECK(crossed > 0);
}

TEST_CASE("the same seed gives the same replan course and a different seed a different course") {
  ReplanCourse a(100, 3), b(100, 3), c(100, 4);
  for (int cycle = 0; cycle < 100; ++cycle)
    for (ReplanCourse* course : {&a, &b, &c}) course->step();
  CHECK(a.start_m() == b.start_m());
  CHECK(a.shortest().states == b.shortest().states);
  CHECK(centre_of(a.domain(), 7) == centre_of(b.domain(), 7));
  CHECK(a.start_m() != c.start_m());
  CHECK(centre_of(a.domain(), 7) != centre_of(c.domain(), 7));
}

}  // namespace sidestep::replan_course_test
