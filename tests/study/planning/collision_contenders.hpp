// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "tests/study/planning/collision_problem.hpp"

namespace sidestep {

/// A structure with the obstacles of a problem, which must outlive it.
struct CollisionContender {
  std::string name;
  std::function<bool(const Segment&)> touches;
  /// Mean time per query over all motions, one after another. The caller only counts the answers.
  std::function<double()> query_ns;
  /// Mean time of a query for one motion, repeated many times.
  std::function<double(const Segment&, std::size_t repetitions)> repeated_ns;
};

/// Our structures, textbook structures (common/collision/baselines) and FCL, always in the same order. Throws
/// std::runtime_error with the reason if one of them gives a wrong answer.
std::vector<CollisionContender> collision_contenders(const CollisionProblem& problem);

}  // namespace sidestep
