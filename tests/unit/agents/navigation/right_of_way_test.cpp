// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/right_of_way.hpp"

#include <algorithm>
#include <vector>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep {
namespace {

constexpr Duration kPeriod = std::chrono::seconds(30);
Time in_period(int number) { return Time(number * kPeriod + kPeriod / 2); }

}  // namespace

TEST_CASE("the robot that is due earlier goes first, and ids decide if both are due at about the same time") {
  const auto due = [](double seconds) { return time_from_ns(1'000'000'000'000) + from_seconds(seconds); };
  CHECK(goes_first({7, due(1)}, {3, due(2)}));
  CHECK_FALSE(goes_first({3, due(2)}, {7, due(1)}));
  CHECK(goes_first({3, due(1.2)}, {7, due(1.1)}));
  CHECK_FALSE(goes_first({7, due(1.1)}, {3, due(1.2)}));
  CHECK(goes_first({7, due(11.2)}, {3, due(11.1)}));
  CHECK_FALSE(goes_first({3, due(11.1)}, {7, due(11.2)}));
  CHECK(goes_first({7, Time{}}, {3, due(1)}));
}

TEST_CASE("exactly one of two robots goes first, and a robot before which another goes is not first itself") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    std::vector<DueRobot> robots;
    for (RobotId robot = 0; robot < 8; ++robot)
      robots.push_back({robot, time_from_ns(static_cast<std::int64_t>(rng.bits()))});  // as hostile as may be
    for (RobotId robot = 8; robot < 16; ++robot)
      robots.push_back({robot, time_from_ns(static_cast<std::int64_t>(rng.below(1'000'000'000)))});
    std::vector<int> ahead;  // number of robots that precede each robot
    for (const DueRobot& self : robots)
      ahead.push_back(static_cast<int>(std::ranges::count_if(robots, [&](const DueRobot& other) {
        return other.robot != self.robot && goes_first(other, self);
      })));
    std::ranges::sort(ahead);
    for (int i = 0; i < 16; ++i) CHECK(ahead[static_cast<std::size_t>(i)] == i);
  }
}

TEST_CASE("the robot with the older order goes first in a passage, but every fourth period is random") {
  int reversed = 0;
  for (int period = 0; period < 400; ++period) {
    CAPTURE(period);
    const bool is_older_first = other_passes_first({9, 100}, {2, 101}, in_period(period), kPeriod);
    if (period % 4 != 0) CHECK(is_older_first);
    reversed += is_older_first ? 0 : 1;
  }
  CHECK(reversed > 25);
  CHECK(reversed < 75);
}

TEST_CASE("robots in a passage agree on their sequence in each period") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    std::vector<PassageContender> contenders;
    for (RobotId robot = 0; robot < 8; ++robot) contenders.push_back({robot, rng.below(3)});
    const Time t = in_period(static_cast<int>(rng.below(1000)));
    std::vector<int> ahead;  // number of robots that precede each robot
    for (const PassageContender& self : contenders) {
      int count = 0;
      for (const PassageContender& other : contenders)
        if (other.robot != self.robot) count += other_passes_first(other, self, t, kPeriod) ? 1 : 0;
      ahead.push_back(count);
    }
    std::ranges::sort(ahead);
    CHECK(ahead == std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7});
  }
}

TEST_CASE("each of several robots with equally old orders soon goes first in a passage") {
  std::vector<int> first(6, 0);
  for (int period = 0; period < 600; ++period)
    for (RobotId robot = 0; robot < 6; ++robot) {
      bool is_first = true;
      for (RobotId other = 0; other < 6; ++other)
        if (other != robot && other_passes_first({other, 1}, {robot, 1}, in_period(period), kPeriod))
          is_first = false;
      if (is_first) ++first[robot];
    }
  for (const int count : first) CHECK(count > 60);
}

}  // namespace sidestep
