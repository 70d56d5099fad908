// SPDX-License-Identifier: Apache-2.0
#include "deploy/evaluation/planning/ompl_planner.hpp"

#include <algorithm>
#include <ompl/base/MotionValidator.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/ProjectionEvaluator.h>
#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/PathSimplifier.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/kpiece/KPIECE1.h>
#include <ompl/geometric/planners/rrt/RRT.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include "deploy/evaluation/planning/cpu_clock.hpp"

namespace sidestep {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

Vec2 place_of(const ob::State* state) {
  const auto* values = state->as<ob::RealVectorStateSpace::StateType>();
  return {(*values)[0], (*values)[1]};
}

/// The same exact check that our planners ask.
class ExactMotions : public ob::MotionValidator {
 public:
  ExactMotions(const ob::SpaceInformationPtr& space, const ObstacleWorld& obstacles, double radius_m)
      : ob::MotionValidator(space), obstacles_(obstacles), radius_m_(radius_m) {}

  bool checkMotion(const ob::State* from, const ob::State* to) const override {
    return !obstacles_.touches(place_of(from), place_of(to), radius_m_);
  }
  bool checkMotion(const ob::State* from, const ob::State* to,
                   std::pair<ob::State*, double>& last_valid) const override {
    if (checkMotion(from, to)) return true;
    if (last_valid.first) si_->copyState(last_valid.first, from);
    last_valid.second = 0;
    return false;
  }

 private:
  const ObstacleWorld& obstacles_;
  double radius_m_;
};

/// The place itself, for planners that look at where states are.
class PlaceProjection : public ob::ProjectionEvaluator {
 public:
  PlaceProjection(const ob::StateSpacePtr& space, double cell_m)
      : ob::ProjectionEvaluator(space), cell_m_(cell_m) {}
  unsigned int getDimension() const override { return 2; }
  void defaultCellSizes() override { cellSizes_ = {cell_m_, cell_m_}; }
  void project(const ob::State* state, Eigen::Ref<Eigen::VectorXd> projection) const override {
    const Vec2 place = place_of(state);
    projection(0) = place.x();
    projection(1) = place.y();
  }

 private:
  double cell_m_;
};

std::vector<Vec2> places_of(og::PathGeometric& path) {
  std::vector<Vec2> places;
  for (const ob::State* state : path.getStates()) places.push_back(place_of(state));
  return places;
}

}  // namespace

struct OmplPlanner::Parts {
  std::string name;
  double cell_m;
  ob::StateSpacePtr space;
  ob::SpaceInformationPtr information;

  ob::PlannerPtr make() const {
    if (name == "ompl-RRTConnect") return std::make_shared<og::RRTConnect>(information);
    if (name == "ompl-RRT") return std::make_shared<og::RRT>(information);
    if (name == "ompl-BIT*") return std::make_shared<og::BITstar>(information);
    const auto kpiece = std::make_shared<og::KPIECE1>(information);
    kpiece->setProjectionEvaluator(std::make_shared<PlaceProjection>(space, cell_m));
    return kpiece;
  }
};

const std::vector<std::string>& ompl_planner_names() {
  static const std::vector<std::string> names{"ompl-RRTConnect", "ompl-RRT", "ompl-KPIECE", "ompl-BIT*"};
  return names;
}

bool is_ompl_planner(const std::string& name) {
  const auto& names = ompl_planner_names();
  return std::find(names.begin(), names.end(), name) != names.end();
}

OmplPlanner::OmplPlanner(const std::string& name, const PlanWorld& world, const ObstacleWorld& obstacles,
                         std::uint64_t seed)
    : parts_(std::make_unique<Parts>()) {
  ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
  // Once in a process: OMPL complains otherwise.
  static const bool seeded = (ompl::RNG::setSeed(static_cast<std::uint_fast32_t>(seed)), true);
  static_cast<void>(seeded);
  const auto space = std::make_shared<ob::RealVectorStateSpace>(2);
  ob::RealVectorBounds bounds(2);
  const double half[2] = {world.field.length_m / 2 - world.radius_m,
                          world.field.width_m / 2 - world.radius_m};
  for (unsigned axis = 0; axis < 2; ++axis) {
    bounds.setLow(axis, -half[axis]);
    bounds.setHigh(axis, half[axis]);
  }
  space->setBounds(bounds);
  parts_->name = name;
  parts_->cell_m = world.field.length_m / 20;
  parts_->space = space;
  parts_->information = std::make_shared<ob::SpaceInformation>(space);
  parts_->information->setStateValidityChecker(
      [&obstacles, radius_m = world.radius_m](const ob::State* state) {
        return !obstacles.touches(place_of(state), radius_m);
      });
  parts_->information->setMotionValidator(
      std::make_shared<ExactMotions>(parts_->information, obstacles, world.radius_m));
  parts_->information->setup();
}

OmplPlanner::~OmplPlanner() = default;

BenchedPlan OmplPlanner::plan(const PlanQuery& query, double milliseconds) {
  const auto problem = std::make_shared<ob::ProblemDefinition>(parts_->information);
  ob::ScopedState<> start(parts_->space), goal(parts_->space);
  for (unsigned axis = 0; axis < 2; ++axis) {
    start[axis] = query.start_m[axis];
    goal[axis] = query.goal_m[axis];
  }
  problem->setStartAndGoalStates(start, goal);
  // Planners that improve their ways stop at the first.
  const auto objective = std::make_shared<ob::PathLengthOptimizationObjective>(parts_->information);
  objective->setCostThreshold(objective->infiniteCost());
  problem->setOptimizationObjective(objective);
  const ob::PlannerPtr planner = parts_->make();
  planner->setProblemDefinition(problem);
  planner->setup();
  BenchedPlan plan;
  const double begin_us = cpu_us(), end_us = begin_us + 1e3 * milliseconds;
  // As our budget does: the clock costs as much as a sample.
  std::size_t asked = 0;
  const auto is_over = [&] { return ++asked % 16 == 0 && cpu_us() >= end_us; };
  const ob::PlannerStatus status = planner->solve(ob::PlannerTerminationCondition(is_over));
  plan.plan_us = cpu_us() - begin_us;
  plan.solved = status == ob::PlannerStatus::EXACT_SOLUTION;
  if (!plan.solved) return plan;
  og::PathGeometric path(*problem->getSolutionPath()->as<og::PathGeometric>());
  plan.raw = places_of(path);
  const double planned_us = cpu_us();
  og::PathSimplifier(parts_->information).simplifyMax(path);
  plan.smooth_us = cpu_us() - planned_us;
  plan.smooth = places_of(path);
  return plan;
}

}  // namespace sidestep
