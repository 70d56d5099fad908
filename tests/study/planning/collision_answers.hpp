// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "tests/study/planning/collision_problem.hpp"

namespace sidestep {

/// A structure's answers to the question whether each motion of a problem touches.
struct CollisionAnswers {
  std::string structure;
  double tolerance_m;  ///< distance from contact within which either answer is correct
  std::vector<bool> touches;
};

/// Describes each wrong answer. If structures disagree about a motion, it is compared exactly with every
/// obstacle.
[[nodiscard]] std::vector<std::string> wrong_answers(const CollisionProblem& problem,
                                                     std::span<const CollisionAnswers> answers);

}  // namespace sidestep
