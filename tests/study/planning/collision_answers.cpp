// SPDX-License-Identifier: Apache-2.0
#include "tests/study/planning/collision_answers.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace sidestep {

std::vector<std::string> wrong_answers(const CollisionProblem& problem,
                                       std::span<const CollisionAnswers> answers) {
  std::vector<std::string> wrong;
  for (std::size_t i = 0; i < problem.motions.size(); ++i) {
    const auto disagrees = [&](const CollisionAnswers& other) {
      return other.touches[i] != answers.front().touches[i];
    };
    if (std::none_of(answers.begin(), answers.end(), disagrees)) continue;
    double nearest2_m2 = 1;
    for (const Shape& shape : problem.shapes)
      nearest2_m2 = std::min(nearest2_m2, squared_distance(problem.motions[i], shape));
    const double gap_m = std::sqrt(nearest2_m2) - problem.radius_m;
    for (const CollisionAnswers& one : answers) {
      if (std::abs(gap_m) <= one.tolerance_m || one.touches[i] == (gap_m < 0)) continue;
      wrong.push_back(fmt::format("{}: wrong answer for a path {:.3g} m from contact", one.structure, gap_m));
    }
  }
  return wrong;
}

}  // namespace sidestep
