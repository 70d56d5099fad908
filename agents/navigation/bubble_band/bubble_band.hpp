// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "agents/navigation/bubble_band/bubble.hpp"

namespace sidestep {

struct BubbleBandSettings {
  /// Far along the band, obstacles near the robot are ignored: they may have moved by the time the robot
  /// arrives. The distance from the robot within which they are ignored grows with the path length, from 0 to
  /// max_masked_m. With 0, nothing is ignored; Philippsen uses 4.
  double max_masked_m = 0;
};

/// A band of overlapping free bubbles from the robot to its goal (Quinlan, Khatib 1993; Philippsen, EPFL
/// thesis 3146, ch. 3). It starts as a planner's path. Each update moves the bubbles: internal forces shorten
/// the band, external forces keep it away from obstacles. While the band is not broken, a disc of the robot's
/// radius can follow the polyline of the centres without touching any obstacle, except obstacles that are
/// masked (ignored; see max_masked_m). A broken band must be restarted with a new path.
///
/// `FreeSpace` is ObstaclePoints, DistanceFunction, or any function that takes a position and the masked
/// distance and returns a FreeDistance. Does not allocate once warm.
class BubbleBand {
 public:
  /// Throws std::invalid_argument if the radius is not positive or too large.
  explicit BubbleBand(double robot_radius_m, const BubbleBandSettings& settings = {});

  /// Starts along a path from the robot to the goal. Throws std::invalid_argument if the path has no point,
  /// or has a point that is not finite.
  template <typename FreeSpace>
  void start(std::span<const Vec2> path_m, const FreeSpace& free) {
    begin(path_m);
    measure_all(Query(free));
    fit(Query(free));
  }
  /// Moves the start of the band to the robot, and the bubbles by one step. Throws std::invalid_argument if
  /// the position is not finite or start() was not called.
  template <typename FreeSpace>
  void update(const Vec2& robot_m, const FreeSpace& free) {
    follow(robot_m);
    measure_all(Query(free));
    step(Query(free));
    fit(Query(free));
  }

  /// Whether the robot does not fit through some place in the band. If so, a new path must be planned.
  bool is_broken() const { return is_broken_; }
  /// The bubbles, from the robot to the goal.
  std::span<const Bubble> bubbles() const { return bubbles_; }
  double length_m() const { return bubbles_.empty() ? 0 : bubbles_.back().path_m; }
  /// The position on the band at a path length from the robot, or the goal if the band is shorter.
  /// Precondition: the band was started.
  Vec2 position_m(double ahead_m) const;
  /// The distance from the robot within which a bubble at a path length ignores obstacles.
  double masked_m(double path_m) const;

 private:
  /// A reference to a FreeSpace.
  class Query {
   public:
    template <typename FreeSpace>
    explicit Query(const FreeSpace& free)
        : object_(&free), call_([](const void* object, const Vec2& at_m, double masked_m) {
            return (*static_cast<const FreeSpace*>(object))(at_m, masked_m);
          }) {}
    FreeDistance operator()(const Vec2& at_m, double masked_m) const {
      return call_(object_, at_m, masked_m);
    }

   private:
    const void* object_;
    FreeDistance (*call_)(const void*, const Vec2&, double);
  };

  void begin(std::span<const Vec2> path_m);
  void follow(const Vec2& robot_m);
  /// Moves the bubbles, but no bubble so far that the robot would no longer fit through.
  void step(const Query& free);
  /// Removes and inserts bubbles, and checks the passages between them.
  void fit(const Query& free);
  void measure(Bubble& bubble, const Query& free) const;
  void measure_all(const Query& free);
  bool is_superfluous(const Bubble& before, const Bubble& bubble, const Bubble& after) const;
  void remove_superfluous();
  /// Appends bubbles after the last bubble in kept_ until the passage to `next` is wide enough or the spacing
  /// too small.
  void insert_before(const Bubble& next, const Query& free);

  double robot_radius_m_;
  BubbleBandSettings settings_;
  std::vector<Bubble> bubbles_, kept_, pending_;
  bool is_broken_ = true;
};

}  // namespace sidestep
