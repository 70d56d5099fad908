// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/course_leader.hpp"

#include <map>
#include <set>

#include "agents/navigation/right_of_way.hpp"
#include "tests/catch.hpp"
#include "tests/unit/agents/navigation/driving_courses.hpp"

namespace sidestep::course_leader_test {

using namespace std::chrono_literals;

constexpr Time kNow = time_from_ns(1'800'000'000'000'000'000);
constexpr Duration kCycle{16'666'667};

/// A robot that leads others on an empty floor.
struct Leader {
  explicit Leader(const Field& field = {6, 6}) : search(rules_on(field), ObstacleWorld()) {}

  static FloorRules rules_on(const Field& field) {
    FloorRules rules;
    rules.field = field;
    return rules;
  }
  std::span<const CourseOffer> plan(const DrivingCourse& own, const std::vector<DrivingCourse>& others,
                                    Time start) {
    std::vector<const DrivingCourse*> known;
    for (const DrivingCourse& other : others)
      if (other.robot != own.robot) known.push_back(&other);
    return leader.plan({start, own, known, leaving_m, staying_m, limits}, rng);
  }

  FloorRules rules = rules_on({});
  CourseSearch search;
  CourseConflicts conflicts{rules.min_separation_m() - 0.004};
  CourseLeader leader{search, conflicts};
  std::vector<Vec2> leaving_m, staying_m;
  MotionLimits limits;
  Rng rng{1};
};

const double kSeparation_m = FloorRules{}.min_separation_m();

/// A course from rest to rest of a robot that is due in this quarter of a second after kNow, counted from 0.
/// Courses that are due in earlier ones precede those that are due in later ones.
DrivingCourse course_due_in(RobotId robot, int quarter, const Vec2& from_m, const Vec2& to_m) {
  DrivingCourse course = direct_course(robot, kNow, {from_m, {0, 0}}, to_m);
  course.due = kNow + quarter * 250ms;
  return course;
}

bool have_conflict(const DrivingCourse& a, const DrivingCourse& b) {
  return CourseConflicts(kSeparation_m - 0.004).first_after(a, b, kNow).has_value();
}

/// Replaces the courses by those that have been offered.
void take(std::span<const CourseOffer> offers, std::vector<DrivingCourse>& courses) {
  for (const CourseOffer& offer : offers)
    for (DrivingCourse& course : courses)
      if (course.robot == offer.course.robot && course.planned_at == offer.replaces) course = offer.course;
}

//       ^
//       |
//  a ---+--->
//       |
//       b
const DrivingCourse kA = course_due_in(1, 0, {-1.5, 0}, {1.5, 0}),
                    kB = course_due_in(2, 1, {0, -1.5}, {0, 1.5});

TEST_CASE("of two robots whose courses conflict, only the one that precedes offers the other a course") {
  REQUIRE(have_conflict(kA, kB));
  CHECK(Leader().plan(kB, {kA}, kNow + kCycle).empty());
  Leader leader;
  const Time start = kNow + kCycle;
  const auto offers = leader.plan(kA, {kB}, start);
  REQUIRE(offers.size() == 1);
  CHECK(offers[0].by == kA.robot);
  CHECK(offers[0].replaces == kB.planned_at);
  const DrivingCourse& course = offers[0].course;
  CHECK(course.robot == kB.robot);
  CHECK(course.start == start + CourseLeader::kOfferLead);
  CHECK(course.due == kB.due);
  CHECK_FALSE(course.continues);
  CHECK((course.goal_m() - kB.goal_m()).norm() < 1e-6);
  CHECK((course.states.front().position_m - kB.state_at(course.start).position_m).norm() < 1e-9);
  CHECK((course.states.front().velocity_mps - kB.state_at(course.start).velocity_mps).norm() < 1e-9);
  CHECK_FALSE(have_conflict(kA, course));
  CHECK(nearest_m(kA, course, start) >= kSeparation_m);
}

TEST_CASE("an offered course will be continued like the course that it replaces") {
  DrivingCourse b = kB;
  b.continues = true;
  Leader leader;
  const auto offers = leader.plan(kA, {b}, kNow + kCycle);
  REQUIRE(offers.size() == 1);
  CHECK(offers[0].course.continues);
}

TEST_CASE("an offered course is no faster than the course that it replaces") {
  MotionLimits slow;
  slow.speed_mps = 0.8;
  DrivingCourse b = course_of(2, fastest_stop(kNow, {{0, -0.6}, {0, 0}}, {0, 1.5}, slow));
  b.due = kB.due;
  REQUIRE(have_conflict(kA, b));
  Leader leader;
  const auto offers = leader.plan(kA, {b}, kNow + kCycle);
  REQUIRE(offers.size() == 1);
  for (const State& state : offers[0].course.states) CHECK(state.velocity_mps.norm() < 0.8 + 1e-6);
}

TEST_CASE("an offered course keeps its distance from robots that stay and from courses that precede it") {
  const DrivingCourse c = course_due_in(3, 0, {0.5, -1.4}, {0.5, 1.4});
  Leader leader;
  leader.staying_m = {{-0.4, 0.6}};
  REQUIRE(precedes(c, kB));
  REQUIRE_FALSE(have_conflict(kA, c));
  REQUIRE_FALSE(have_conflict(kB, c));
  const auto offers = leader.plan(kA, {kB, c}, kNow + kCycle);
  std::vector<DrivingCourse> courses{kA, kB, c};
  REQUIRE(offers.size() > 0);
  take(offers, courses);
  const DrivingCourse resting = course_of(9, Trajectory::resting(kNow, leader.staying_m[0]));
  CHECK(nearest_m(courses[1], resting, kNow + kCycle) >= kSeparation_m);
  for (std::size_t i = 0; i < courses.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) CHECK_FALSE(have_conflict(courses[i], courses[j]));
}

TEST_CASE("robots without conflict get no offers") {
  const DrivingCourse c = course_due_in(3, 2, {-1.5, -0.3}, {1.5, -0.3}),
                      d = course_due_in(4, 3, {-0.9, 2}, {1.5, 2});
  CHECK(Leader().plan(kA, {c, d}, kNow + kCycle).empty());
  CHECK(Leader().plan(kA, {}, kNow + kCycle).empty());
  // The conflict of two others is no matter of a robot that conflicts with neither.
  const DrivingCourse e = course_due_in(5, 4, {0, 2.9}, {0, 0.5});
  REQUIRE(have_conflict(d, e));
  REQUIRE_FALSE(have_conflict(kA, e));
  CHECK(Leader().plan(kA, {d, e}, kNow + kCycle).empty());
}

//           ^       ^
//  b --->---+-------+--->
//           |       |
//           a       c       Each of them meets b, but a and c do not meet.
std::vector<DrivingCourse> chain(int due_a, int due_b, int due_c) {
  return {course_due_in(1, due_a, {-0.5, -1}, {-0.5, 1}), course_due_in(2, due_b, {-1.5, 0}, {1.5, 0}),
          course_due_in(3, due_c, {0.8, -2.3}, {0.8, 1.5})};
}

TEST_CASE("in a chain of conflicts, the first robot offers courses without any conflict") {
  for (const auto& [first, due] :
       std::map<std::size_t, std::array<int, 3>>{{0, {0, 1, 2}}, {1, {2, 0, 1}}, {2, {2, 1, 0}}}) {
    CAPTURE(first);
    std::vector<DrivingCourse> courses = chain(due[0], due[1], due[2]);
    REQUIRE(have_conflict(courses[0], courses[1]));
    REQUIRE(have_conflict(courses[1], courses[2]));
    REQUIRE_FALSE(have_conflict(courses[0], courses[2]));
    for (std::size_t own = 0; own < 3; ++own) {
      CAPTURE(own);
      if (own != first) CHECK(Leader().plan(courses[own], courses, kNow + kCycle).empty());
    }
    Leader leader;
    const auto offers = leader.plan(courses[first], courses, kNow + kCycle);
    CHECK_FALSE(offers.empty());
    take(offers, courses);
    CHECK_FALSE(have_conflict(courses[0], courses[1]));
    CHECK_FALSE(have_conflict(courses[1], courses[2]));
    CHECK_FALSE(have_conflict(courses[0], courses[2]));
  }
}

TEST_CASE("a robot does not lead if a member of its group precedes it") {
  // a precedes b, but c, which does not conflict with a, precedes both.
  const std::vector<DrivingCourse> courses = chain(1, 2, 0);
  CHECK(Leader().plan(courses[0], courses, kNow + kCycle).empty());
  CHECK(Leader().plan(courses[0], {courses[0], courses[1]}, kNow + kCycle).size() == 1);
}

/// The robots that are connected to a robot by conflicts, including itself.
std::set<RobotId> connected_to(RobotId robot, const std::vector<DrivingCourse>& courses) {
  std::set<RobotId> connected{robot};
  for (std::size_t before = 0; before != connected.size();) {
    before = connected.size();
    for (const DrivingCourse& a : courses)
      for (const DrivingCourse& b : courses)
        if (a.robot != b.robot && connected.contains(a.robot) && have_conflict(a, b))
          connected.insert(b.robot);
  }
  return connected;
}

TEST_CASE("of robots that are connected by conflicts, only the first one offers courses, and only to them") {
  int offered = 0;
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    Rng rng(seed);
    std::vector<DrivingCourse> courses;
    for (RobotId robot = 0; robot < 6; ++robot) {
      const Vec2 from_m = random_vector(rng, 2.5), to_m = random_vector(rng, 2.5);
      courses.push_back(course_due_in(robot, static_cast<int>(rng.below(3)), from_m, to_m));
    }
    for (const DrivingCourse& own : courses) {
      CAPTURE(seed, own.robot);
      const std::set<RobotId> group = connected_to(own.robot, courses);
      const bool is_first = std::ranges::none_of(courses, [&](const DrivingCourse& other) {
        return group.contains(other.robot) && precedes(other, own);
      });
      Leader leader;
      for (const CourseOffer& offer : leader.plan(own, courses, kNow)) {
        ++offered;
        CHECK(is_first);
        CHECK(group.contains(offer.course.robot));
        CHECK(offer.course.robot != own.robot);
      }
    }
  }
  CHECK(offered > 20);
}

TEST_CASE("an offer that was taken is not repeated") {
  Leader leader;
  std::vector<DrivingCourse> courses{kA, kB};
  std::optional<DrivingCourse> offered;
  int count = 0;
  for (Time start = kNow + kCycle; start < kNow + 1500ms; start += kCycle) {
    CAPTURE(to_seconds(start - kNow));
    for (const CourseOffer& offer : leader.plan(kA, courses, start)) {
      ++count;
      offered = offer.course;
    }
    if (offered && offered->start <= start) courses[1] = *offered;
  }
  CHECK(count == 1);
}

TEST_CASE("an offer that was not taken is repeated after a fifth of a second") {
  Leader leader;
  std::vector<Time> offered_at;
  for (Time start = kNow + kCycle; start < kNow + 500ms; start += kCycle)
    for (const CourseOffer& offer : leader.plan(kA, {kB}, start)) {
      CHECK(offer.replaces == kB.planned_at);
      offered_at.push_back(start);
    }
  REQUIRE(offered_at.size() >= 2);
  CHECK(offered_at[0] == kNow + kCycle);
  for (std::size_t i = 1; i < offered_at.size(); ++i) {
    CHECK(offered_at[i] - offered_at[i - 1] >= 200ms);
    CHECK(offered_at[i] - offered_at[i - 1] <= 200ms + 2 * kCycle);
  }
}

TEST_CASE("a robot that has planned another course instead of taking the offer soon gets another offer") {
  Leader leader;
  REQUIRE(leader.plan(kA, {kB}, kNow + kCycle).size() == 1);
  DrivingCourse other = kB;
  other.planned_at += 3 * kCycle;
  const auto offers = leader.plan(kA, {other}, kNow + 4 * kCycle);
  REQUIRE(offers.size() == 1);
  CHECK(offers[0].replaces == other.planned_at);
}

//       ^   ^   ^   ^   ^   ^
//  a ---+---+---+---+---+---+--->
//       |   |   |   |   |   |       a meets each of six robots.
TEST_CASE("no more than four courses are offered in a cycle, the first ones first, and then the others") {
  const DrivingCourse a = course_due_in(1, 0, {-2.5, 0}, {2.5, 0});
  std::vector<DrivingCourse> courses{a};
  for (int i = 0; i < 6; ++i) {
    const double way_m = 0.6 + 0.4 * i, x = -2.5 + way_m;
    courses.push_back(course_due_in(static_cast<RobotId>(10 + i), 9 - i, {x, -way_m}, {x, 1.2}));
    REQUIRE(have_conflict(a, courses.back()));
  }
  Leader leader;
  Time start = kNow + kCycle;
  std::vector<RobotId> offered_to;
  const auto first = leader.plan(a, courses, start);
  REQUIRE(first.size() == 4);
  for (const CourseOffer& offer : first) offered_to.push_back(offer.course.robot);
  CHECK(offered_to == std::vector<RobotId>{15, 14, 13, 12});
  std::vector<DrivingCourse> after = courses;
  take(first, after);
  start += kCycle;
  const auto second = leader.plan(a, courses, start);
  for (const CourseOffer& offer : second) {
    CHECK((offer.course.robot == 11 || offer.course.robot == 10));
    offered_to.push_back(offer.course.robot);
  }
  take(second, after);
  for (std::size_t i = 0; i < after.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      CAPTURE(after[i].robot, after[j].robot);
      CHECK_FALSE(have_conflict(after[i], after[j]));
    }
}

TEST_CASE("no course is offered to robots that drive far away") {
  Leader leader({40, 8});
  const DrivingCourse a = course_due_in(1, 0, {-1.5, 0}, {1.5, 0}),
                      far = course_due_in(2, 1, {1, -0.3}, {-15, 3.5});
  REQUIRE(have_conflict(a, far));
  CHECK(leader.plan(a, {far}, kNow).empty());
  CHECK(leader.plan(a, {kB}, kNow).size() == 1);
}

TEST_CASE("a robot that has a millimetre to drive is no reason to offer a course that leads into the way") {
  const DrivingCourse b = course_due_in(2, 1, {0, 0}, {0.0015, 0});
  REQUIRE(have_conflict(kA, b));
  Leader leader;
  for (const CourseOffer& offer : leader.plan(kA, {b}, kNow + kCycle))
    CHECK_FALSE(have_conflict(kA, offer.course));
}

TEST_CASE("no course is offered to a robot that rests in the way") {
  DrivingCourse resting = course_of(2, Trajectory::resting(kNow, {0, 0}));
  resting.due = kB.due;
  REQUIRE(have_conflict(kA, resting));
  CHECK(Leader().plan(kA, {resting}, kNow + kCycle).empty());
  // It has arrived a while ago.
  DrivingCourse arrived = course_of(2, fastest_stop(kNow - 5s, {{0, -1}, {0, 0}}, {0, 0}, {}));
  arrived.due = kB.due;
  REQUIRE(have_conflict(kA, arrived));
  Leader leader;
  for (const CourseOffer& offer : leader.plan(kA, {arrived}, kNow + kCycle))
    CHECK_FALSE(have_conflict(kA, offer.course));
}

}  // namespace sidestep::course_leader_test
