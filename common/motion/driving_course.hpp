// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "common/motion/trajectory.hpp"
#include "common/motion/version.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// A robot's planned motion to its goal. Robots plan around the courses of others, and follow their own.
/// Safety does not rely on courses: robots drive granted versions only.
struct DrivingCourse {
  static constexpr Duration kSample{50'000'000};
  static constexpr std::size_t kMaxStates = 512;
  /// Courses are repeated more often than this. A course that is not repeated is forgotten, because its agent
  /// may have ended.
  static constexpr Duration kMaxSilence{1'500'000'000};
  /// Courses start within a few cycles, and none takes a minute.
  static constexpr Duration kMaxLead{5'000'000'000}, kMaxAge{60'000'000'000};

  RobotId robot = 0;
  Time planned_at{};  ///< identifies the course among those of its robot
  Time due{};         ///< when the robot is due at its goal; see right_of_way.hpp
  Time start{};
  bool continues = false;  ///< the robot will not rest at the last state, but plan its way from there in time
  std::vector<State> states;  ///< at the start and every kSample after it; the last one is at rest

  /// Whether the robot has no course. Nothing below may be called then.
  bool is_empty() const { return states.empty(); }
  const Vec2& goal_m() const { return states.back().position_m; }
  Time end() const { return start + kSample * static_cast<std::int64_t>(states.size() - 1); }
  /// Whether the course starts no more than kMaxAge before a time, and no more than kMaxLead after it.
  bool is_about(Time t) const { return start <= t + kMaxLead && start >= t - kMaxAge; }
  /// The state at a time: at rest before the start and after the end. Exact if the acceleration is constant
  /// between two samples.
  State state_at(Time t) const;
  /// The position at a time, on the straight line between two samples.
  Vec2 position_at(Time t) const;
};

/// A course that one robot has planned for another one, which may take it instead of its present course.
struct CourseOffer {
  DrivingCourse course;
  Time replaces{};  ///< `planned_at` of the course that it replaces
  RobotId by = 0;   ///< the robot that offers it
};

}  // namespace sidestep
