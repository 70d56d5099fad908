// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "common/motion/trajectory.hpp"

namespace sidestep {

/// A robot's planned motion over all time: a sequence of trajectories, each of which starts where the
/// previous one ends. The robot rests before the first and after the last. Between two trajectories it rests,
/// or the second continues the motion of the first at once.
class Course {
 public:
  Course() = default;
  /// Rests from `start` on.
  Course(Time start, const Vec2& position_m) : legs_{Trajectory::resting(start, position_m)} {}

  /// Precondition: the leg starts where the course ends, and not earlier than it ends. If it starts later,
  /// both are at rest then; otherwise it has the velocity with which the course ends.
  void append(const Trajectory& leg) { legs_.push_back(leg); }

  /// The legs; during the first leg the robot rests at the start.
  std::span<const Trajectory> legs() const { return legs_; }
  Time end() const { return legs_.back().end(); }
  Vec2 rest_position_m() const { return legs_.back().rest_position_m(); }
  State state_at(Time t) const;

 private:
  std::vector<Trajectory> legs_;
};

/// Whether a robot that executes `motion` keeps `min_separation_m` from a robot on this course, from the
/// start of the motion until `until`. The robot may still be moving then. If `until` is Time::max(), there is
/// no end. Uses the exact clearance of common/motion.
[[nodiscard]] bool is_clear(const Course& course, const Trajectory& motion, Time until,
                            double min_separation_m);

}  // namespace sidestep
