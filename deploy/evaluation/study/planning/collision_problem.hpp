// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/collision/shapes.hpp"
#include "deploy/evaluation/planning/cpu_clock.hpp"

namespace sidestep {

/// Obstacles that cover a fifth of the unit square, and short ways of a small robot among them: sizes go with
/// the distance between obstacles, so the world only becomes larger as their number grows, and hits stay as
/// frequent.
struct CollisionProblem {
  /// Circles, or boxes, segments and pentagons too.
  CollisionProblem(std::size_t obstacles, std::size_t ways, bool circles_only, std::uint64_t seed);

  static constexpr double kCovered = 0.2;

  std::vector<Shape> shapes{};
  std::vector<Segment> ways{};
  double radius_m = 0;  ///< of the robot
};

/// Whether what touches a robot on its way is waited for.
enum class AnswerUse {
  kCounted,   ///< queries overlap
  kBranched,  ///< what is done next depends on the answer, as in planners
};

/// Asks all ways and returns how long one took. `ask` takes a way and says whether it touches.
template <AnswerUse kUse, typename Ask>
double query_ns(const CollisionProblem& problem, const Ask& ask) {
  std::size_t clear = 0;
  const double begin_us = cpu_us();
  for (const Segment& way : problem.ways) {
    const bool touches = ask(way);
    if constexpr (kUse == AnswerUse::kBranched) {
      if (touches) {
        asm volatile("nop" ::: "memory");
        continue;
      }
      ++clear;
    } else {
      clear += !touches;
    }
  }
  const double end_us = cpu_us();
  asm volatile("" : : "r"(clear));
  return 1e3 * (end_us - begin_us) / static_cast<double>(problem.ways.size());
}

}  // namespace sidestep
