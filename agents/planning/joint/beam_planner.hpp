// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <utility>
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
  /// Distance between two robots' centres that has to remain if both brake at once, from any step on until
  /// the final motion to rest; 0: not checked.
  double braking_separation_m = 0;
  /// How far courses may leave the rectangle between start and goal.
  double detour_m = 100;
};

/// One robot's part of a joint planning problem.
struct BeamQuery {
  Vec2 start_m{0, 0}, goal_m{0, 0};
  MotionLimits limits{};
  Vec2 start_mps{0, 0};                      ///< velocity at the start
  std::span<const TimedPositions> others{};  ///< robots that follow known courses
  std::span<const Vec2> waiting_m{};         ///< robots without a course; they leave after a moment
  double latest_s = 1e9;                     ///< courses that arrive later are of no use
  /// An attempt ends with what it has found when it has expanded this many states.
  std::size_t max_expanded = std::numeric_limits<std::size_t>::max();
};

/// A set of cells of the state space, for few cells and many questions.
class CellSet {
 public:
  /// Removes all cells, and makes room for `count`.
  void clear(std::size_t count);
  bool contains(std::uint64_t cell) const { return slots_[slot_of(cell)] == cell; }
  void insert(std::uint64_t cell) { slots_[slot_of(cell)] = cell; }

 private:
  static constexpr std::uint64_t kEmpty = std::numeric_limits<std::uint64_t>::max();
  /// The place of the cell, or the empty one where it would be.
  std::size_t slot_of(std::uint64_t cell) const;

  std::vector<std::uint64_t> slots_;  // their number is a power of two
};

/// Plans the motion of one robot at full speed among robots that follow known courses: a beam search in
/// position, velocity and time. In each step the robot holds one of a set of accelerations; the states with
/// the earliest estimated arrivals are kept. A TimeToGoalField makes the estimates. A course ends with the
/// fastest motion to rest at the goal from one of the states. Courses keep the required distances between
/// samples too. A robot that is already closer to another one may stay as close for a moment. Incomplete.
class BeamPlanner {
 public:
  /// The problem must outlive this object.
  explicit BeamPlanner(const JointProblem& problem, const BeamSettings& settings = {});

  [[nodiscard]] std::optional<SampledCourse> plan(const BeamQuery& query, Rng& rng) {
    return plan(query, {&settings_, 1}, rng);
  }
  /// Tries the given settings one after another until one of them finds a course. Their detour_m must be
  /// equal.
  [[nodiscard]] std::optional<SampledCourse> plan(const BeamQuery& query,
                                                  std::span<const BeamSettings> attempts, Rng& rng);
  /// The fastest motion to rest at the goal, if it is free.
  [[nodiscard]] std::optional<SampledCourse> plan_straight(const BeamQuery& query);

  /// Whether robots can rest at all these positions at the same time.
  [[nodiscard]] bool can_rest_at(std::span<const Vec2> positions_m) const;

  /// Number of states expanded so far.
  std::size_t expanded() const { return expanded_; }
  /// The effort of all searches so far, estimates included, in states that could have been expanded instead.
  std::size_t effort() const { return expanded_ + field_.computed_cells() / kCellsPerState; }

 private:
  /// As many cells of the field are computed in the time in which a state is expanded.
  static constexpr std::size_t kCellsPerState = 2'000;
  struct Node {
    State state;
    Vec2 acceleration_mps2{0, 0};  // that led here from the parent
    std::uint32_t parent = 0;
    double estimate_s = 0;  // of the arrival
  };
  /// Another robot's positions at the samples of one step, and its velocity at the end.
  struct Passing {
    std::array<Vec2, 3> at_m;
    double separation_m;
    Vec2 velocity_mps;
  };
  /// The part of passing_ that a node may meet in the present step.
  struct PassingRange {
    std::uint32_t begin = 0, end = 0;
  };
  /// One attempt, with settings_.
  std::optional<SampledCourse> search(const BeamQuery& query, Rng& rng);
  /// The distance to keep from another robot that was this far away at the start.
  double separation_m(double at_start_m, std::size_t sample) const;
  void set_separations(const BeamQuery& query);
  PassingRange find_passing(const BeamQuery& query, const State& state, std::size_t step);
  /// Adds to the candidates the states that a node's accelerations lead to.
  void expand(const BeamQuery& query, std::uint32_t parent, std::size_t step, Rng& rng);
  bool is_possible(const Node& candidate, const PassingRange& passing) const;
  /// Whether the distances remain if the robot and the others brake at once.
  bool can_brake(const State& state, const PassingRange& passing) const;
  /// Moves the most promising of the candidates to the nodes, at most one for each cell of the state space.
  /// `begin` is the first node of the step that has been expanded.
  void keep_best_candidates(const BeamQuery& query, std::size_t begin, std::size_t step);
  /// Drops the candidates that are in a wide cell which is taken.
  void drop_taken();
  /// Tries to end the course at a node; keeps the result if it arrives earlier than the best so far.
  void try_stop(const BeamQuery& query, std::uint32_t node, std::size_t step);
  bool is_clear(const Vec2& from_m, const Vec2& to_m) const;
  bool is_free(const BeamQuery& query, const Trajectory& motion, std::size_t sample) const;
  /// The times at which estimates look at the field.
  struct Moments {
    TimeToGoalField::Moment present, ahead;
  };
  double estimate_s(const State& state, double t_s, const Moments& moments) const;
  SampledCourse course_to(const BeamQuery& query, std::uint32_t node) const;

  const JointProblem* problem_;
  BeamSettings settings_;
  TimeToGoalField field_;
  double separation_m_ = 0, from_obstacles_m_ = 0;       // include the error of sampling
  std::vector<double> at_start_m_, waiting_at_start_m_;  // distances of the others at the start
  double max_deceleration_mps2_ = 1;
  static constexpr std::size_t kNeverFree = std::numeric_limits<std::size_t>::max();
  std::size_t goal_free_from_ = 0;  // sample from which on no other robot is near the goal
  std::vector<Node> nodes_, candidates_;
  std::vector<Passing> passing_;
  std::vector<std::optional<PassingRange>> passing_of_;  // indexed by node of the present step
  std::vector<std::pair<double, std::uint32_t>> order_;  // estimates and numbers of candidates
  CellSet cells_, wide_cells_;
  std::optional<Trajectory> best_stop_;
  std::uint32_t best_node_ = 0;
  double best_s_ = 0;
  std::size_t expanded_ = 0;
};

}  // namespace sidestep
