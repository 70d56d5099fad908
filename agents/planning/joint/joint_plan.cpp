// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/joint/joint_plan.hpp"

#include <algorithm>
#include <stdexcept>

namespace sidestep {

void check(const JointProblem& problem) {
  if (!problem.world) throw std::invalid_argument("a joint planning problem needs a world");
  if (problem.starts_m.empty()) throw std::invalid_argument("a joint planning problem needs robots");
  if (problem.goals_m.size() != problem.starts_m.size())
    throw std::invalid_argument("a joint planning problem needs one goal for each robot");
}

double JointPlan::makespan_s() const {
  Time end{};
  for (const Course& course : courses) end = std::max(end, course.end());
  return to_seconds(end - Time{});
}

}  // namespace sidestep
