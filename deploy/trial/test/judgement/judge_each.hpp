// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>

#include "deploy/trial/test/judgement/judge.hpp"

namespace sidestep {

/// Judges each robot separately. A failure outweighs "not judged". The result has the worst outcome of all
/// robots, at its earliest time, with the reasons of the first robots that have it.
template <typename JudgeRobot>
Judgement judge_each(const RobotSet& robots, JudgeRobot judge_robot) {
  constexpr int kShown = 3;
  Judgement worst;
  int count = 0;
  for (const RobotId robot : robots.ids) {
    const Judgement one = judge_robot(robot);
    if (one.outcome == Outcome::kPassed) continue;
    if (worst.outcome == Outcome::kPassed ||
        (worst.outcome == Outcome::kNotJudged && one.outcome == Outcome::kFailed)) {
      worst = one;
      count = 1;
    } else if (one.outcome == worst.outcome) {
      worst.at_s = std::min(worst.at_s, one.at_s);
      if (++count <= kShown && one.reason != worst.reason) worst.reason += "; " + one.reason;
    }
  }
  if (count > kShown) worst.reason += "; and " + std::to_string(count - kShown) + " more robots";
  return worst;
}

}  // namespace sidestep
