// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/right_of_way.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep {
namespace {

constexpr Duration kPeriod = std::chrono::seconds(30);
Time in_period(int number) { return Time(number * kPeriod + kPeriod / 2); }

/// The beginning of a quarter of a second within which due times are equal, and of ten seconds in which ids
/// count up.
constexpr Time kInterval = time_from_ns(1'800'000'000'000'000'000);

/// The course of a robot that is due this long after kInterval.
DrivingCourse course_due(RobotId robot, Duration due) {
  DrivingCourse course;
  course.robot = robot;
  course.due = kInterval + due;
  return course;
}

/// Any time, as hostile as may be.
Time hostile_time(Rng& rng) {
  using Limits = std::numeric_limits<std::int64_t>;
  switch (rng.below(4)) {
    case 0:
      return time_from_ns(static_cast<std::int64_t>(rng.bits()));
    case 1:
      return time_from_ns(rng.chance(0.5) ? Limits::max() : Limits::min());
    case 2:
      return time_from_ns(static_cast<std::int64_t>(rng.below(7)) - 3);
    default:
      return kInterval + from_seconds(rng.uniform(-0.5, 0.5));
  }
}

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

TEST_CASE("of two courses, the one whose robot is due in an earlier quarter of a second precedes") {
  using namespace std::chrono_literals;
  CHECK(precedes(course_due(7, 0ms), course_due(3, 250ms)));
  CHECK_FALSE(precedes(course_due(3, 250ms), course_due(7, 0ms)));
  CHECK(precedes(course_due(7, 250ms - 1ns), course_due(3, 250ms)));
  CHECK_FALSE(precedes(course_due(3, 250ms), course_due(7, 250ms - 1ns)));
  CHECK(precedes(course_due(3, -1ns), course_due(7, 0ms)));
  CHECK(precedes(course_due(7, -1ns), course_due(3, 0ms)));
}

TEST_CASE("courses due in the same quarter of a second go by ids, which count up and down in turn") {
  using namespace std::chrono_literals;
  for (const Duration up : {0ms, 250ms, 9750ms, 20000ms}) {
    CAPTURE(to_seconds(up));
    CHECK(precedes(course_due(3, up + 250ms - 1ns), course_due(7, up)));
    CHECK_FALSE(precedes(course_due(7, up), course_due(3, up + 250ms - 1ns)));
  }
  for (const Duration down : {-250ms, 10000ms, 19750ms}) {
    CAPTURE(to_seconds(down));
    CHECK(precedes(course_due(7, down + 250ms - 1ns), course_due(3, down)));
    CHECK_FALSE(precedes(course_due(3, down), course_due(7, down + 250ms - 1ns)));
  }
  CHECK_FALSE(precedes(course_due(3, 0ms), course_due(3, 0ms)));
}

TEST_CASE("a robot that plans another course keeps its place in the order of courses") {
  using namespace std::chrono_literals;
  DrivingCourse other = course_due(3, 250ms), course = course_due(7, 0ms);
  other.planned_at = other.start = kInterval - 3s;
  for (const Duration later : {0s, 1s, 60s}) {
    CAPTURE(to_seconds(later));
    course.planned_at = course.start = other.planned_at + later;
    CHECK(precedes(course, other));
    CHECK_FALSE(precedes(other, course));
  }
}

TEST_CASE("all courses are in one order, whichever times they contain") {
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    std::vector<DrivingCourse> courses(12);
    for (RobotId robot = 0; robot < courses.size(); ++robot) {
      courses[robot].robot = robot;
      courses[robot].planned_at = hostile_time(rng);
      courses[robot].due = hostile_time(rng);
    }
    std::vector<std::ptrdiff_t> ahead, expected;  // number of courses that precede each course
    for (const DrivingCourse& course : courses) {
      expected.push_back(static_cast<std::ptrdiff_t>(expected.size()));
      ahead.push_back(std::ranges::count_if(
          courses, [&](const DrivingCourse& other) { return precedes(other, course); }));
      for (const DrivingCourse& other : courses)
        if (other.robot != course.robot) CHECK(precedes(other, course) != precedes(course, other));
    }
    std::ranges::sort(ahead);
    CHECK(ahead == expected);
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
