// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "tests/study/planning/collision_problem.hpp"

namespace sidestep {

/// A structure that contains the obstacles of a problem. The problem must outlive it.
struct CollisionContender {
  std::string name;
  std::function<bool(const Segment&)> touches;
  /// Returns the mean time per query over all motions, one after another. The answers are only counted, so
  /// successive queries overlap in the processor.
  std::function<double()> query_ns;
  /// Returns the mean time of a query for one motion, repeated many times.
  std::function<double(const Segment&, std::size_t repetitions)> repeated_ns;
};

/// Our structures, textbook structures (common/collision/baselines) and FCL, always in the same order. Throws
/// std::runtime_error with the reason if one of them gives a wrong answer.
std::vector<CollisionContender> collision_contenders(const CollisionProblem& problem);

}  // namespace sidestep
