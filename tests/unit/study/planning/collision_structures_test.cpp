// SPDX-License-Identifier: Apache-2.0
#include "tests/study/planning/collision_structures.hpp"

#include <set>

#include "tests/catch.hpp"
#include "tests/study/planning/collision_answers.hpp"
#include "tests/study/planning/collision_domains.hpp"
#include "tests/study/planning/fcl_tree.hpp"
#include "tests/unit/study/study_files.hpp"

namespace sidestep::collision_structures_test {

TEST_CASE("the experiment on collision structures depends only on its seed") {
  check_experiment([](std::uint64_t seed, const ProgressCallback& advance) {
    return collision_structures({{4, 64}, 500, 2}, seed, advance);
  });
}

TEST_CASE("the experiment on collision domains depends only on its seed") {
  check_experiment([](std::uint64_t seed, const ProgressCallback& advance) {
    return collision_domains({.obstacles = 64, .queries = 200, .repetitions = 2, .rounds = 2}, seed, advance);
  });
}

TEST_CASE("the obstacles of a grid are at the centres of equal squares") {
  const CollisionProblem problem(64, 10, true, 1, ObstacleLayout::kGrid);
  std::set<std::pair<double, double>> centres;
  for (const Shape& shape : problem.shapes) {
    const Vec2 square = 8 * std::get<Circle>(shape).centre_m - Vec2(0.5, 0.5);
    CHECK(square == Vec2(square.array().round()));
    CHECK((square.minCoeff() == 0 || square.minCoeff() >= 1));
    CHECK(square.maxCoeff() <= 7);
    centres.emplace(square.x(), square.y());
  }
  CHECK(centres.size() == 64);
}

TEST_CASE("a structure that disagrees with the others and gives a wrong answer is reported") {
  const CollisionProblem problem(64, 200, true, 1);
  CollisionAnswers right{"right", 1e-9, {}};
  for (const Segment& motion : problem.motions)
    right.touches.push_back(
        std::any_of(problem.shapes.begin(), problem.shapes.end(), [&](const Shape& shape) {
          return squared_distance(motion, shape) <= problem.radius_m * problem.radius_m;
        }));
  CollisionAnswers wrong = right;
  wrong.structure = "wrong";
  wrong.touches[17] = !wrong.touches[17];
  CHECK(wrong_answers(problem, std::vector{right, right}).empty());
  const std::vector<std::string> found = wrong_answers(problem, std::vector{right, wrong});
  REQUIRE(found.size() == 1);
  CHECK_THAT(found[0], StartsWith("wrong: wrong answer for a path"));
}

TEST_CASE("all collision structures of the study agree with an exact comparison") {
  const auto seed = GENERATE(1u, 2u);
  const std::size_t obstacles = GENERATE(4u, 64u, 1024u);
  constexpr std::size_t kMotions = 1000;
  CAPTURE(seed, obstacles);
  const CollisionProblem problem(obstacles, kMotions, true, seed);
  std::size_t touched = 0;
  for (const Segment& motion : problem.motions) {
    const double radius2_m2 = problem.radius_m * problem.radius_m;
    const auto touches = [&](const Shape& shape) { return squared_distance(motion, shape) <= radius2_m2; };
    touched += std::any_of(problem.shapes.begin(), problem.shapes.end(), touches);
  }
  const auto rows = rows_of(collision_structures({{obstacles}, kMotions, 1}, seed, [](auto, auto) {}));
  CHECK(rows.size() == 8);
  for (const StudyRow& row : rows) {
    CAPTURE(row.at("structure"));
    CHECK(std::stod(row.at("touch_percent")) == Approx(100.0 * double(touched) / kMotions));
  }
}

TEST_CASE("the obstacles of a collision problem cover the same area for any number of obstacles") {
  const std::size_t obstacles = GENERATE(256u, 4096u);
  CAPTURE(obstacles);
  const CollisionProblem problem(obstacles, 10, true, 3);
  double area_m2 = 0;
  for (const Shape& shape : problem.shapes) {
    const double radius_m = std::get<Circle>(shape).radius_m;
    area_m2 += 3.14159265 * radius_m * radius_m;
  }
  CHECK(area_m2 == Approx(CollisionProblem::kCovered).epsilon(0.1));
}

}  // namespace sidestep::collision_structures_test
