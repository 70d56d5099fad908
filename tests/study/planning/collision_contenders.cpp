// SPDX-License-Identifier: Apache-2.0
#include "tests/study/planning/collision_contenders.hpp"

#include <memory>
#include <stdexcept>

#include "common/collision/baselines/baseline_world.hpp"
#include "common/collision/baselines/partition_tree.hpp"
#include "common/collision/baselines/spatial_hash.hpp"
#include "common/collision/baselines/sweep_and_prune.hpp"
#include "tests/study/planning/collision_answers.hpp"
#include "tests/study/planning/fcl_tree.hpp"

namespace sidestep {
namespace {

constexpr double kTolerance_m = 1e-9;

template <typename World>
CollisionContender contender(const char* name, const CollisionProblem& problem,
                             const std::shared_ptr<World>& world) {
  const auto query = [world, &touching = *world, radius_m = problem.radius_m](const Segment& motion) {
    return touching.touches(motion.from_m, motion.to_m, radius_m);
  };
  const auto repeated = [query](const Segment& motion, std::size_t repetitions) {
    const double begin_us = cpu_us();
    for (std::size_t i = 0; i < repetitions; ++i) {
      bool touches = query(motion);
      asm volatile("" : "+r"(touches) : "r"(&motion) : "memory");
    }
    return 1e3 * (cpu_us() - begin_us) / static_cast<double>(repetitions);
  };
  return {name, query, [&problem, query] { return query_ns<AnswerUse::kCounted>(problem, query); }, repeated};
}

template <typename Set>
CollisionContender baseline(const char* name, const CollisionProblem& problem) {
  return contender(name, problem, std::make_shared<baselines::BaselineWorld<Set>>(problem.shapes));
}

}  // namespace

std::vector<CollisionContender> collision_contenders(const CollisionProblem& problem) {
  const auto ours = [&](const char* name, Structure structure) {
    return contender(name, problem, std::make_shared<ObstacleWorld>(problem.shapes, structure));
  };
  std::vector<CollisionContender> contenders{ours("linear", Structure::kLinear),
                                             ours("extent masks", Structure::kMasks),
                                             ours("tree of boxes", Structure::kTree),
                                             baseline<baselines::SpatialHash>("spatial hash", problem),
                                             baseline<baselines::SweepAndPrune>("sweep and prune", problem),
                                             baseline<baselines::KdTree>("K-D tree", problem),
                                             baseline<baselines::BspTree>("BSP tree", problem)};
  contenders.push_back(contender("FCL tree of boxes", problem, std::make_shared<FclTree>(problem.shapes)));

  std::vector<CollisionAnswers> answers;
  for (const CollisionContender& contender : contenders) {
    answers.push_back({contender.name, kTolerance_m, {}});
    for (const Segment& motion : problem.motions) answers.back().touches.push_back(contender.touches(motion));
  }
  const std::vector<std::string> wrong = wrong_answers(problem, answers);
  if (!wrong.empty()) throw std::runtime_error(wrong.front());
  return contenders;
}

}  // namespace sidestep
