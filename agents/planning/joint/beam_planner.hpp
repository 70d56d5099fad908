// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "agents/planning/joint/joint_plan.hpp"
#include "agents/planning/joint/sampled_course.hpp"
#include "agents/planning/joint/time_to_goal_field.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

struct BeamSettings {
  std::size_t width = 250;   ///< number of states kept in each step of 0.1 s: those with the best estimates
  std::size_t varied = 100;  ///< number of further states kept, each from another part of the state space
  std::size_t stops = 16;  ///< number of states in each step from which a motion to rest at the goal is tried
};

/// One robot's part of a joint planning problem.
struct BeamQuery {
  Vec2 start_m{0, 0}, goal_m{0, 0};
  MotionLimits limits{};
  std::span<const SampledCourse* const> others{};  ///< robots that follow known courses
  std::span<const Vec2> waiting_m{};  ///< starts of robots without a course; they leave after a moment
  double latest_s = 1e9;              ///< courses that arrive later are of no use
};

/// Plans the motion of one robot at full speed among robots that follow known courses: a beam search in
/// position, velocity and time. In each step the robot holds one of a set of accelerations; the states with
/// the earliest estimated arrivals are kept. A TimeToGoalField makes the estimates. A course ends with the
/// fastest motion to rest at the goal from one of the states. Courses keep the required distances between
/// samples too. Incomplete.
class BeamPlanner {
 public:
  /// The problem must outlive this object.
  explicit BeamPlanner(const JointProblem& problem, const BeamSettings& settings = {});

  [[nodiscard]] std::optional<SampledCourse> plan(const BeamQuery& query, Rng& rng);

  /// Whether robots can rest at all these positions at the same time.
  [[nodiscard]] bool can_rest_at(std::span<const Vec2> positions_m) const;

  /// Number of states expanded so far.
  std::size_t expanded() const { return expanded_; }

 private:
  struct Node {
    State state;
    Vec2 acceleration_mps2{0, 0};  // that led here from the parent
    std::uint32_t parent = 0;
    double estimate_s = 0;  // of the arrival
  };
  /// Another robot's positions at the samples of one step.
  struct Passing {
    std::array<Vec2, 3> at_m;
  };
  void find_passing(const BeamQuery& query, const State& state, std::size_t step);
  void expand(const BeamQuery& query, std::uint32_t parent, std::size_t step, Rng& rng);
  /// Moves the most promising of the candidates to the nodes, at most one for each cell of the state space.
  void keep_best_candidates();
  /// Tries to end the course at a node; keeps the result if it arrives earlier than the best so far.
  void try_stop(const BeamQuery& query, std::uint32_t node, std::size_t step);
  bool is_clear(const Vec2& from_m, const Vec2& to_m) const;
  bool is_free(const BeamQuery& query, const Trajectory& motion, std::size_t sample) const;
  double estimate_s(const State& state, double t_s) const;
  SampledCourse course_to(const BeamQuery& query, std::uint32_t node) const;

  const JointProblem* problem_;
  BeamSettings settings_;
  TimeToGoalField field_;
  double separation_m_ = 0, from_obstacles_m_ = 0;  // include the error of sampling
  std::vector<Node> nodes_, candidates_;
  std::vector<Passing> passing_;
  std::optional<Trajectory> best_stop_;
  std::uint32_t best_node_ = 0;
  double best_s_ = 0;
  std::size_t expanded_ = 0;
};

}  // namespace sidestep
