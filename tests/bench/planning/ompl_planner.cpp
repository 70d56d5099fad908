// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/planning/ompl_planner.hpp"

#include <fmt/format.h>
#include <ompl/base/MotionValidator.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/ProjectionEvaluator.h>
#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/config.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/PathSimplifier.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/kpiece/KPIECE1.h>
#include <ompl/geometric/planners/rrt/RRT.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include "agents/planning/named_planner.hpp"
#include "tests/bench/planning/free_fraction.hpp"
#include "tests/study/measurement/cpu_clock.hpp"

namespace sidestep {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

Vec2 position_of(const ob::State* state) {
  const auto* values = state->as<ob::RealVectorStateSpace::StateType>();
  return {(*values)[0], (*values)[1]};
}

/// The same exact check of whole motions that our planners use.
class ExactMotions : public ob::MotionValidator {
 public:
  ExactMotions(const ob::SpaceInformationPtr& space, const ObstacleWorld& obstacles, double radius_m)
      : ob::MotionValidator(space), obstacles_(obstacles), radius_m_(radius_m) {}

  bool checkMotion(const ob::State* from, const ob::State* to) const override {
    return !obstacles_.touches(position_of(from), position_of(to), radius_m_);
  }
  /// KPIECE also asks for the free fraction of a blocked motion.
  bool checkMotion(const ob::State* from, const ob::State* to,
                   std::pair<ob::State*, double>& last_valid) const override {
    if (checkMotion(from, to)) return true;
    last_valid.second = free_fraction(obstacles_, position_of(from), position_of(to), radius_m_);
    if (last_valid.first) si_->getStateSpace()->interpolate(from, to, last_valid.second, last_valid.first);
    return false;
  }

 private:
  const ObstacleWorld& obstacles_;
  double radius_m_;
};

/// Projects a state to its position, in 20 by 20 cells. Replaces OMPL's equivalent default projection for a
/// plane, whose code fails an Eigen assertion in Debian's build.
class PositionProjection : public ob::ProjectionEvaluator {
 public:
  PositionProjection(const ob::StateSpacePtr& space, const Vec2& cell_m)
      : ob::ProjectionEvaluator(space), cell_m_(cell_m) {}
  unsigned int getDimension() const override { return 2; }
  void defaultCellSizes() override { cellSizes_ = {cell_m_.x(), cell_m_.y()}; }
  void project(const ob::State* state, Eigen::Ref<Eigen::VectorXd> projection) const override {
    const Vec2 position = position_of(state);
    projection(0) = position.x();
    projection(1) = position.y();
  }

 private:
  Vec2 cell_m_;
};

std::vector<Vec2> positions_of(og::PathGeometric& path) {
  std::vector<Vec2> positions;
  for (const ob::State* state : path.getStates()) positions.push_back(position_of(state));
  return positions;
}

}  // namespace

struct OmplPlanner::Parts {
  std::string name;
  double range_m = 0;
  Vec2 cell_m;
  ob::StateSpacePtr space;
  ob::SpaceInformationPtr information;

  ob::PlannerPtr make() const {
    if (name == "ompl-BIT*") return std::make_shared<og::BITstar>(information);
    if (name == "ompl-RRTConnect") {
      const auto planner = std::make_shared<og::RRTConnect>(information);
      planner->setRange(range_m);
      return planner;
    }
    if (name == "ompl-RRT") return make_with_goal_bias<og::RRT>();
    const auto planner = make_with_goal_bias<og::KPIECE1>();
    planner->setProjectionEvaluator(std::make_shared<PositionProjection>(space, cell_m));
    return planner;
  }

  template <typename Planner>
  std::shared_ptr<Planner> make_with_goal_bias() const {
    auto planner = std::make_shared<Planner>(information);
    planner->setRange(range_m);
    planner->setGoalBias(kOmplGoalBias);
    return planner;
  }

  ob::ProblemDefinitionPtr problem(const PlanQuery& query) const {
    auto problem = std::make_shared<ob::ProblemDefinition>(information);
    ob::ScopedState<> start(space), goal(space);
    for (unsigned axis = 0; axis < 2; ++axis) {
      start[axis] = query.start_m[axis];
      goal[axis] = query.goal_m[axis];
    }
    problem->setStartAndGoalStates(start, goal);
    // Any cost satisfies the objective, so planners that improve their paths stop at the first one.
    const auto objective = std::make_shared<ob::PathLengthOptimizationObjective>(information);
    objective->setCostThreshold(objective->infiniteCost());
    problem->setOptimizationObjective(objective);
    return problem;
  }
};

const std::vector<std::string>& ompl_planner_names() {
  static const std::vector<std::string> names{"ompl-RRT", "ompl-RRTConnect", "ompl-KPIECE", "ompl-BIT*"};
  return names;
}

std::string ompl_build() {
  const std::string package = SIDESTEP_OMPL_PACKAGE;
  return fmt::format(
      "OMPL {}.{}.{}: {}", OMPL_MAJOR_VERSION, OMPL_MINOR_VERSION, OMPL_PATCH_VERSION,
      package.empty() ? "not from a Debian package, so its compile options are unknown"
                      : "the shared library of the Debian package " + package +
                            ", compiled with Debian's default flags (-O2, no -march), assertions included");
}

OmplPlanner::OmplPlanner(const std::string& name, const BenchmarkWorld& world, std::uint64_t seed)
    : parts_(std::make_unique<Parts>()) {
  ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
  // OMPL accepts only one seed per process.
  static const bool is_seeded = (ompl::RNG::setSeed(static_cast<std::uint_fast32_t>(seed)), true);
  static_cast<void>(is_seeded);
  const auto space = std::make_shared<ob::RealVectorStateSpace>(2);
  const double radius_m = world.world.radius_m;
  const double half_m[2] = {world.world.field.length_m / 2 - radius_m,
                            world.world.field.width_m / 2 - radius_m};
  ob::RealVectorBounds bounds(2);
  for (unsigned axis = 0; axis < 2; ++axis) {
    bounds.setLow(axis, -half_m[axis]);
    bounds.setHigh(axis, half_m[axis]);
  }
  space->setBounds(bounds);
  parts_->name = name;
  parts_->range_m = ompl_range_m(world.world.field, world.world.radius_m);
  parts_->cell_m = Vec2(half_m[0], half_m[1]) / 10;
  parts_->space = space;
  parts_->information = std::make_shared<ob::SpaceInformation>(space);
  parts_->information->setStateValidityChecker(
      [&obstacles = world.obstacles, radius_m](const ob::State* state) {
        return !obstacles.touches(position_of(state), radius_m);
      });
  parts_->information->setMotionValidator(
      std::make_shared<ExactMotions>(parts_->information, world.obstacles, radius_m));
  parts_->information->setup();
}

OmplPlanner::~OmplPlanner() = default;

TimedPlan OmplPlanner::plan(const PlanQuery& query, double max_ms) {
  const ob::ProblemDefinitionPtr problem = parts_->problem(query);
  const ob::PlannerPtr planner = parts_->make();
  planner->setProblemDefinition(problem);
  planner->setup();
  TimedPlan plan;
  const double begin_us = cpu_us(), end_us = begin_us + 1e3 * max_ms;
  // Reads the clock as rarely as our planners' Budget does, because a reading costs as much as a sample.
  const auto is_over = [&] { return ++plan.iterations % 16 == 0 && cpu_us() >= end_us; };
  const ob::PlannerStatus status = planner->solve(ob::PlannerTerminationCondition(is_over));
  plan.plan_us = cpu_us() - begin_us;
  plan.is_solved = status == ob::PlannerStatus::EXACT_SOLUTION;
  if (!plan.is_solved) return plan;
  og::PathGeometric path(*problem->getSolutionPath()->as<og::PathGeometric>());
  plan.path_m = positions_of(path);
  const double planned_us = cpu_us();
  og::PathSimplifier(parts_->information).simplifyMax(path);
  plan.smoothing_us = cpu_us() - planned_us;
  plan.smoothed_m = positions_of(path);
  return plan;
}

}  // namespace sidestep
