// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "deploy/evaluation/study/planning/collision_problem.hpp"

namespace sidestep {

/// Whether each motion of a problem touches, according to a structure.
struct CollisionAnswers {
  std::string structure;
  double tolerance_m;  ///< distance from contact within which either answer is right
  std::vector<bool> touches;
};

/// Describes each wrong answer. Motions about which structures disagree are compared exactly with every
/// obstacle.
[[nodiscard]] std::vector<std::string> wrong_answers(const CollisionProblem& problem,
                                                     std::span<const CollisionAnswers> answers);

}  // namespace sidestep
