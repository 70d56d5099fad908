// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/collision/shapes.hpp"
#include "tests/study/measurement/cpu_clock.hpp"

namespace sidestep {

/// The arrangement of the obstacles.
enum class ObstacleLayout {
  kRandom,  ///< uniformly distributed
  kGrid,    ///< at the centres of equal squares; their number is a square
};

/// Obstacles that cover a fifth of the unit square, and short straight motions of a small robot among them.
/// All sizes scale with the spacing of the obstacles: with more obstacles the robot is smaller and its
/// motions are shorter, so contacts are equally frequent.
struct CollisionProblem {
  /// Unless `circles_only`, the obstacles also include boxes, segments and pentagons.
  CollisionProblem(std::size_t obstacles, std::size_t motions, bool circles_only, std::uint64_t seed,
                   ObstacleLayout layout = ObstacleLayout::kRandom);

  static constexpr double kCovered = 0.2;

  std::vector<Shape> shapes{};
  std::vector<Segment> motions{};
  double radius_m = 0;  ///< radius of the robot
};

/// How the caller uses the answer of a query.
enum class AnswerUse {
  kCounted,   ///< counts it, so that successive queries overlap in the processor
  kBranched,  ///< branches on it, as planners do
};

/// Queries all motions and returns the mean time per query. `query` takes a motion and returns whether it
/// touches.
template <AnswerUse kUse, typename Query>
double query_ns(const CollisionProblem& problem, const Query& query) {
  std::size_t clear = 0;
  const double begin_us = cpu_us();
  for (const Segment& motion : problem.motions) {
    const bool touches = query(motion);
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
  return 1e3 * (end_us - begin_us) / static_cast<double>(problem.motions.size());
}

}  // namespace sidestep
