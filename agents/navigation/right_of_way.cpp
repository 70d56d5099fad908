// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/right_of_way.hpp"

#include <cstdint>
#include <utility>

#include "common/random/rng.hpp"

namespace sidestep {
namespace {

constexpr std::uint64_t kRandomPeriod = 4;
constexpr Duration kSameDue{250'000'000};  ///< robots with due times in one such interval go by their ids
/// Ids count up or down for this many such intervals. Robots that meet are mostly due within them.
constexpr std::int64_t kSameDirection = 40;

std::uint64_t number_of_period(Time t, Duration period) {
  return static_cast<std::uint64_t>(t.time_since_epoch() / period);
}

}  // namespace

bool goes_first(const DueRobot& other, const DueRobot& self) {
  const auto rank = [](const DueRobot& robot) {
    const auto interval = robot.due.time_since_epoch() / kSameDue;
    const auto id = static_cast<std::int64_t>(robot.robot);
    return std::pair(interval, interval / kSameDirection % 2 == 0 ? id : -id);
  };
  return rank(other) < rank(self);
}

bool precedes(const DrivingCourse& a, const DrivingCourse& b) {
  return goes_first(DueRobot{a.robot, a.due}, DueRobot{b.robot, b.due});
}

bool other_passes_first(const PassageContender& other, const PassageContender& self, Time t,
                        Duration period) {
  const std::uint64_t number = number_of_period(t, period);
  if (other.order != self.order && number % kRandomPeriod != 0) return other.order < self.order;
  const auto rank = [&](RobotId robot) { return std::pair(Rng((number << 16) + robot).bits(), robot); };
  return rank(other.robot) < rank(self.robot);
}

}  // namespace sidestep
