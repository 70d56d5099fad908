// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <unordered_map>
#include <vector>

#include "agents/planning/joint/joint_plan.hpp"
#include "agents/planning/joint/sampled_course.hpp"
#include "common/geometry/box.hpp"

namespace sidestep {

/// An estimate of the time that one robot needs to its goal, for every position and time, among robots that
/// follow known courses. It is computed backwards in time on a grid, for a robot that changes its velocity at
/// will up to its speed limit. It guides searches: it knows that a passage will be blocked, and until when.
class TimeToGoalField {
 public:
  static constexpr double kNever_s = std::numeric_limits<double>::infinity();

  /// The problem must outlive this object.
  explicit TimeToGoalField(const JointProblem& problem) : problem_(&problem) {}

  /// Computes the field of a robot that has this goal and speed limit, among others, in an area. Positions
  /// outside the area count as blocked.
  void compute(const Box& area_m, const Vec2& goal_m, double speed_mps,
               std::span<const TimedPositions> others);

  /// Number of cells, in all steps of time, computed so far.
  std::size_t computed_cells() const { return computed_cells_; }

  /// A time step of the field, looked up once for many positions.
  class Moment {
   private:
    friend TimeToGoalField;
    explicit Moment(std::size_t step) : step_(step) {}
    std::size_t step_;
  };
  Moment at_time(double t_s) const;
  /// The time from a position at a time to the goal; kNever_s if the robot would touch something there, or if
  /// no way leads from there to the goal within half a minute.
  double time_to_goal_s(const Vec2& at_m, Moment moment) const;
  double time_to_goal_s(const Vec2& at_m, double t_s) const { return time_to_goal_s(at_m, at_time(t_s)); }

 private:
  /// Times in milliseconds, small enough for fast comparisons of many cells at once.
  using Ms = std::int16_t;
  static constexpr Ms kNever = 30'000;

  /// The least times to the goal in a square of cells: kNever where obstacles are. Tiles are remembered.
  static constexpr std::int64_t kTileCells = 20;
  using Tile = std::array<Ms, kTileCells * kTileCells>;
  const Tile& tile(std::int64_t column, std::int64_t row);
  /// Sets columns_, rows_, origin_m_ and least_.
  void set_area(const Box& area_m);
  Vec2 centre_m(std::size_t cell) const;
  /// Calls `call` with the cells whose centres are closer to a position than a distance.
  template <typename Call>
  void for_each_near(const Vec2& at_m, double distance_m, Call call) const;
  void block(const Vec2& at_m, Ms* times) const;
  /// The field when all other robots rest at the ends of their courses, or have gone where nobody knows.
  void compute_last(std::span<const TimedPositions> others);
  /// Computes the field one step before `later`.
  void step_back(const Ms* later, Ms* times);

  const JointProblem* problem_;
  std::unordered_map<std::int64_t, Tile> tiles_;  // by the numbers of their column and row
  std::size_t columns_ = 0, rows_ = 0;            // with a border of blocked cells, as wide as a step
  Vec2 origin_m_{0, 0};                           // centre of the first cell
  std::vector<Ms> least_;                         // 0, or kNever where obstacles are
  std::vector<Ms> near_, wide_;                   // minima over three and five cells of a row
  double speed_mps_ = 1, step_s_ = 1;
  Vec2 goal_m_{0, 0};
  std::size_t computed_cells_ = 0;
  std::size_t last_ = 0;                             // number of the last step
  std::vector<Ms> times_;                            // indexed by step and cell
  std::vector<std::vector<std::uint32_t>> buckets_;  // working memory of compute_last()
};

}  // namespace sidestep
