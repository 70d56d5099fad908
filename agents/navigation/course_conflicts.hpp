// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>

#include "common/motion/driving_course.hpp"

namespace sidestep {

/// Finds out when courses come too close to each other. Remembers results, because most courses do not change
/// from one cycle to the next.
class CourseConflicts {
 public:
  explicit CourseConflicts(double separation_m) : separation_m_(separation_m) {}

  /// The first time from `from` on at which the robots come too close; nullopt: never.
  std::optional<Time> first_after(const DrivingCourse& a, const DrivingCourse& b, Time from);

 private:
  struct Version {
    Time planned_at{}, start{};
    bool operator==(const Version&) const = default;
  };
  struct Known {
    Version a, b;
    std::optional<Time> searched_from;  // nullopt: not searched yet
    std::optional<Time> first;
  };
  std::optional<Time> search(const DrivingCourse& a, const DrivingCourse& b, Time from) const;

  const double separation_m_;
  std::unordered_map<std::uint64_t, Known> known_;  // by the numbers of the two robots
};

}  // namespace sidestep
