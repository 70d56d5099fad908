// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "agents/planning/joint/beam_planner.hpp"
#include "agents/planning/joint/joint_plan.hpp"

namespace sidestep {

struct NeighbourhoodSettings {
  std::size_t orders = 4;          ///< number of complete plans, in different orders; the best is improved
  std::size_t states = 2'000'000;  ///< number of states expanded to improve the plan, at 2 to 4 µs each
  std::size_t patience = 15;       ///< attempts in a row without success, for each robot, that end it earlier
  std::size_t replanned = 5;       ///< maximum number of robots that an attempt plans anew
  BeamSettings beam{};
};

/// Plans the motions of all robots at full speed, for a short mean arrival time relative to the straight line
/// (large neighbourhood search; Li et al., Anytime multi-agent path finding via large neighbourhood search,
/// 2021). Robots are planned one after another, in several orders. Then a robot that is late and robots in
/// its way are planned anew in another order, again and again; plans that are better are kept. The effort
/// does not depend on a clock, so a seed gives the same plan everywhere.
class NeighbourhoodPlanner {
 public:
  /// Throws std::invalid_argument if the settings leave nothing to try: no order, fewer than two robots
  /// planned anew, or a beam without states.
  explicit NeighbourhoodPlanner(const NeighbourhoodSettings& settings = {});

  /// `speed_limits_mps` has the speed limit of each robot; if it is empty, the problem's limit applies to
  /// all. Returns kUnreachable if starts or goals touch each other, an obstacle or the border, or if a robot
  /// has no way to its goal. Throws std::invalid_argument for problems that check() refuses, and for speed
  /// limits that are not positive or whose number is wrong.
  [[nodiscard]] JointPlan plan(const JointProblem& problem, std::span<const double> speed_limits_mps,
                               Rng& rng);

 private:
  struct Robot {
    BeamQuery query;        // without others
    double straight_s = 0;  // the time for the straight line
    SampledCourse alone;    // the robot's course without other robots
    SampledCourse course;
    bool is_planned = false;
    double ratio(double arrival_s) const { return straight_s > 0 ? arrival_s / straight_s : 0; }
    double loss() const { return ratio(course.arrival_s() - alone.arrival_s()); }
  };

  void set_robots(const JointProblem& problem, std::span<const double> speed_limits_mps);
  bool plan_alone(BeamPlanner& planner, Rng& rng);
  /// Plans the robot around all robots that have a course.
  bool plan_robot(std::size_t robot, double latest_s, BeamPlanner& planner, Rng& rng);
  /// Plans all robots. Returns the first position in the order whose robot has no course, or the number of
  /// robots.
  std::size_t plan_in_order(const std::vector<std::size_t>& order, BeamPlanner& planner, Rng& rng);
  bool find_first_plan(BeamPlanner& planner, Rng& rng);
  double mean_loss() const;
  void improve(BeamPlanner& planner, Rng& rng);
  /// Plans a late robot and robots in its way anew, and keeps the result if it is better.
  void replan_some(BeamPlanner& planner, Rng& rng);
  std::vector<std::size_t> choose_neighbourhood(Rng& rng) const;

  NeighbourhoodSettings settings_;
  double separation_m_ = 0;
  std::vector<Robot> robots_;
};

}  // namespace sidestep
