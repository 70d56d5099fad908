// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/course_book.hpp"

#include <algorithm>
#include <map>

#include "tests/catch.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

namespace sidestep::course_book_test {

using namespace std::chrono_literals;

constexpr RobotId kSelf = 3;
constexpr Time kNow = time_from_ns(1'800'000'000'000'000'000);
const FloorRules kRules = [] {
  FloorRules rules;
  rules.field = {200, 200};
  return rules;
}();

DrivingCourse resting(RobotId robot, const Vec2& place_m, Time planned_at = kNow) {
  DrivingCourse course;
  course.robot = robot;
  course.planned_at = course.due = course.start = planned_at;
  course.states = {{place_m, {0, 0}}};
  return course;
}

void hear(CourseBook& book, const DrivingCourse& course, Time now) {
  book.on_course(std::make_shared<const DrivingCourse>(course), now);
}

void hear_offer(CourseBook& book, RobotId by, RobotId to, Time now, Time replaces = kNow) {
  book.on_offer(std::make_shared<const CourseOffer>(CourseOffer{resting(to, {0, 0}), replaces, by}), now);
}

std::vector<RobotId> robots_nearby(CourseBook& book, Time now, double horizon_m = 5) {
  std::vector<RobotId> robots;
  for (const DrivingCourse* course : book.nearby({0, 0}, horizon_m, now)) robots.push_back(course->robot);
  return robots;
}

Time planned_at(CourseBook& book, Time now) {
  const auto nearby = book.nearby({0, 0}, 5, now);
  return nearby.size() == 1 ? nearby[0]->planned_at : Time{};
}

TEST_CASE("a later course of a robot replaces an earlier one, and not the other way round") {
  CourseBook book(kSelf, kRules);
  hear(book, resting(1, {0, 0}, kNow), kNow);
  CHECK(planned_at(book, kNow) == kNow);
  hear(book, resting(1, {0, 0}, kNow + 10ms), kNow + 20ms);
  CHECK(planned_at(book, kNow + 20ms) == kNow + 10ms);
  hear(book, resting(1, {0, 0}, kNow + 9ms), kNow + 30ms);
  CHECK(planned_at(book, kNow + 30ms) == kNow + 10ms);
}

TEST_CASE("the same course with another start replaces the one that is known: its robot was held back") {
  CourseBook book(kSelf, kRules);
  DrivingCourse course = resting(1, {0, 0});
  hear(book, course, kNow);
  course.start += 40ms;
  hear(book, course, kNow + 50ms);
  const auto nearby = book.nearby({0, 0}, 5, kNow + 50ms);
  REQUIRE(nearby.size() == 1);
  CHECK(nearby[0]->start == course.start);
}

TEST_CASE(
    "an earlier course is accepted once nothing has been heard for a while: the robot's clock was set back") {
  CourseBook book(kSelf, kRules);
  hear(book, resting(1, {0, 0}, kNow), kNow);
  const DrivingCourse earlier = resting(1, {0, 0}, kNow - 50s);
  for (Duration after = 100ms; after <= 1500ms; after += 100ms) {
    CAPTURE(to_seconds(after));
    hear(book, earlier, kNow + after);
    CHECK(planned_at(book, kNow + after) == kNow);
  }
  hear(book, earlier, kNow + 1600ms);
  CHECK(planned_at(book, kNow + 1600ms) == kNow - 50s);
}

TEST_CASE("courses that are not repeated are forgotten after one and a half seconds") {
  CourseBook book(kSelf, kRules);
  hear(book, resting(1, {0, 0}), kNow);
  hear(book, resting(2, {0, 0}), kNow);
  CHECK(robots_nearby(book, kNow + 1s) == std::vector<RobotId>{1, 2});
  hear(book, resting(2, {0, 0}), kNow + 1s);
  CHECK(robots_nearby(book, kNow + 1500ms) == std::vector<RobotId>{1, 2});
  CHECK(robots_nearby(book, kNow + 1501ms) == std::vector<RobotId>{2});
  CHECK(robots_nearby(book, kNow + 2500ms) == std::vector<RobotId>{2});
  CHECK(robots_nearby(book, kNow + 2501ms).empty());
}

TEST_CASE("courses that no robot can drive on this floor are ignored, and offers of them") {
  DrivingCourse drivable = resting(7, {1, 0});
  drivable.states = {{{1, 0}, {2, 0}}, {{1.1, 0}, {2, 0}}, {{1.2, 0}, {0, 0}}};
  const auto count = [&](auto spoil) {
    DrivingCourse course = drivable;
    spoil(course);
    CourseBook book(kSelf, kRules);
    hear(book, course, kNow);
    book.on_offer(std::make_shared<const CourseOffer>(CourseOffer{course, kNow, 5}), kNow);
    const std::size_t courses = book.nearby({0, 0}, 500, kNow).size();
    CHECK(book.offers(kNow).size() == courses);
    return courses;
  };
  CHECK(count([](DrivingCourse&) {}) == 1);
  CHECK(count([](DrivingCourse& course) { course.states[1].velocity_mps = {0, 3}; }) == 0);
  CHECK(count([](DrivingCourse& course) { course.states[1].position_m.y() = 0.3; }) == 0);
  CHECK(count([](DrivingCourse& course) {
          for (State& state : course.states) state.position_m.x() += 100;
        }) == 0);
}

TEST_CASE("courses that start more than a minute before or five seconds later are ignored") {
  const auto is_stored = [](Duration later) {
    DrivingCourse course = resting(7, {1, 0});
    course.start = kNow + later;
    CourseBook book(kSelf, kRules);
    hear(book, course, kNow);
    return !book.nearby({0, 0}, 5, kNow).empty();
  };
  CHECK(is_stored(-60s));
  CHECK_FALSE(is_stored(-60s - 1ns));
  CHECK(is_stored(5s));
  CHECK_FALSE(is_stored(5s + 1ns));
}

TEST_CASE("a robot that offers courses to many others displaces no offers of others") {
  CourseBook book(kSelf, kRules);
  for (RobotId to = 100; to < 164; ++to) hear_offer(book, 5, to, kNow);
  CHECK(book.offers(kNow).size() == 16);
  hear_offer(book, 6, 100, kNow);
  CHECK(book.offers(kNow).size() == 17);
}

TEST_CASE("courses are forgotten if the clock is set back, too, and heard again") {
  CourseBook book(kSelf, kRules);
  hear(book, resting(1, {0, 0}), kNow);
  CHECK(robots_nearby(book, kNow - 1s) == std::vector<RobotId>{1});
  CHECK(robots_nearby(book, kNow - 2s).empty());
  hear(book, resting(1, {0, 0}, kNow - 3s), kNow - 2s);
  CHECK(planned_at(book, kNow - 2s) == kNow - 3s);
}

TEST_CASE("an empty course removes a robot's course, and an earlier one does not bring it back") {
  CourseBook book(kSelf, kRules);
  hear(book, resting(1, {0, 0}), kNow);
  DrivingCourse none = resting(1, {0, 0}, kNow + 10ms);
  none.states.clear();
  hear(book, none, kNow + 10ms);
  CHECK(robots_nearby(book, kNow + 10ms).empty());
  hear(book, resting(1, {0, 0}, kNow + 5ms), kNow + 20ms);
  CHECK(robots_nearby(book, kNow + 20ms).empty());
  hear(book, resting(1, {0, 0}, kNow + 15ms), kNow + 30ms);
  CHECK(robots_nearby(book, kNow + 30ms) == std::vector<RobotId>{1});
}

TEST_CASE("an empty course that is planned earlier than the known one does not remove it") {
  CourseBook book(kSelf, kRules);
  hear(book, resting(1, {0, 0}), kNow);
  DrivingCourse none = resting(1, {0, 0}, kNow - 10ms);
  none.states.clear();
  hear(book, none, kNow + 10ms);
  CHECK(robots_nearby(book, kNow + 10ms) == std::vector<RobotId>{1});
}

TEST_CASE("a robot ignores messages about its own course, and its own offers") {
  CourseBook book(kSelf, kRules);
  hear(book, resting(kSelf, {0, 0}), kNow);
  CHECK(robots_nearby(book, kNow).empty());
  hear_offer(book, kSelf, 5, kNow);
  CHECK(book.offers(kNow).empty());
  hear_offer(book, 5, kSelf, kNow);
  CHECK(book.offers(kNow).size() == 1);
}

TEST_CASE("robots are nearby where their courses have led them by now") {
  CourseBook book(kSelf, kRules);
  DrivingCourse course = resting(1, {-6, 0});
  for (int i = 1; i <= 20; ++i) course.states.push_back({{-6 + 0.1 * i, 0}, {0, 0}});
  hear(book, course, kNow);
  CHECK(robots_nearby(book, kNow).empty());
  CHECK(robots_nearby(book, kNow + 490ms).empty());
  CHECK(robots_nearby(book, kNow + 510ms) == std::vector<RobotId>{1});
}

TEST_CASE("courses of robots farther than eight metres away are ignored, and forgotten when they go there") {
  CourseBook book(kSelf, kRules);
  book.set_place({1, 0});
  hear(book, resting(1, {8.9, 0}), kNow);
  hear(book, resting(2, {9.1, 0}), kNow);
  CHECK(robots_nearby(book, kNow, 50) == std::vector<RobotId>{1});
  book.set_place({0, 0});
  CHECK(robots_nearby(book, kNow + 300ms, 50).empty());
}

TEST_CASE("courses and offers remain valid until the next call, although newer ones are heard") {
  CourseBook book(kSelf, kRules);
  const auto old_course = std::make_shared<const DrivingCourse>(resting(1, {0, 0}));
  const auto old_offer = std::make_shared<const CourseOffer>(CourseOffer{resting(2, {0, 0}), kNow, 1});
  book.on_course(old_course, kNow);
  book.on_offer(old_offer, kNow);
  const auto courses = book.nearby({0, 0}, 5, kNow);
  const auto offers = book.offers(kNow);
  hear(book, resting(1, {1, 0}, kNow + 10ms), kNow + 10ms);
  hear_offer(book, 1, 2, kNow + 10ms);
  REQUIRE(courses.size() == 1);
  REQUIRE(offers.size() == 1);
  CHECK(courses[0] == old_course.get());
  CHECK(offers[0] == old_offer.get());
  CHECK(old_course.use_count() == 2);
  CHECK(old_offer.use_count() == 2);
  (void)book.nearby({0, 0}, 5, kNow + 10ms);
  (void)book.offers(kNow + 10ms);
  CHECK(old_course.use_count() == 1);
  CHECK(old_offer.use_count() == 1);
}

TEST_CASE("of many robots nearby, the forty nearest count, in the order of their numbers") {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const auto count = static_cast<RobotId>(10 + rng.below(70));
    CourseBook book(1000, kRules);
    std::vector<std::pair<double, RobotId>> by_distance;
    const Vec2 centre_m = random_vector(rng, 3);
    for (RobotId robot = 0; robot < count; ++robot) {
      const Vec2 place_m = random_vector(rng, 6);
      hear(book, resting(robot, place_m), kNow);
      const double distance_m = (place_m - centre_m).norm();
      if (distance_m <= 5) by_distance.emplace_back(distance_m, robot);
    }
    std::ranges::sort(by_distance);
    if (by_distance.size() > 40) by_distance.resize(40);
    std::vector<RobotId> expected, nearby;
    for (const auto& [distance_m, robot] : by_distance) expected.push_back(robot);
    std::ranges::sort(expected);
    for (const DrivingCourse* course : book.nearby(centre_m, 5, kNow)) nearby.push_back(course->robot);
    CHECK(nearby == expected);
  }
}

TEST_CASE("an offer counts for a fifth of a second, also if the clock is set back") {
  CourseBook book(kSelf, kRules);
  hear_offer(book, 1, 2, kNow);
  REQUIRE(book.offers(kNow).size() == 1);
  CHECK(book.offers(kNow)[0]->by == 1);
  CHECK(book.offers(kNow + 200ms).size() == 1);
  CHECK(book.offers(kNow + 201ms).empty());
  hear_offer(book, 1, 2, kNow);
  CHECK(book.offers(kNow - 201ms).empty());
}

TEST_CASE("the latest offer of a robot to another one replaces the last one") {
  CourseBook book(kSelf, kRules);
  hear_offer(book, 1, 2, kNow, kNow - 2s);
  hear_offer(book, 1, 4, kNow, kNow - 2s);
  hear_offer(book, 5, 2, kNow, kNow - 2s);
  hear_offer(book, 1, 2, kNow + 10ms, kNow - 1s);
  const auto offers = book.offers(kNow + 10ms);
  CHECK(offers.size() == 3);
  int replaced = 0;
  for (const CourseOffer* offer : offers)
    if (offer->by == 1 && offer->course.robot == 2) {
      ++replaced;
      CHECK(offer->replaces == kNow - 1s);
    }
  CHECK(replaced == 1);
}

TEST_CASE("no more than 64 offers are kept at a time") {
  CourseBook book(kSelf, kRules);
  for (RobotId to = 10; to < 110; ++to) hear_offer(book, 1 + 10 * (to % 10), to, kNow);
  CHECK(book.offers(kNow).size() == 64);
  // A newer offer to the same robot is kept nevertheless.
  hear_offer(book, 1, 10, kNow + 1ms, kNow - 1s);
  const auto offers = book.offers(kNow + 1ms);
  CHECK(offers.size() == 64);
  CHECK(std::ranges::count_if(offers,
                              [](const CourseOffer* offer) { return offer->replaces == kNow - 1s; }) == 1);
  hear_offer(book, 1, 200, kNow + 300ms);
  CHECK(book.offers(kNow + 300ms).size() == 1);
}

/// A course of two seconds from a random place in a random direction.
DrivingCourse driving(RobotId robot, Rng& rng, Time planned_at) {
  DrivingCourse course = resting(robot, random_vector(rng, 4), planned_at);
  const Vec2 velocity_mps = random_vector(rng, 1.4);
  State at = course.states.front();
  at.velocity_mps = velocity_mps;
  course.states.assign(1, at);
  for (int sample = 0; sample < 40; ++sample) {
    at.position_m += to_seconds(DrivingCourse::kSample) * velocity_mps;
    course.states.push_back(at);
  }
  course.states.back().velocity_mps.setZero();
  return course;
}

TEST_CASE("the book knows for each robot what a slow record of all messages knows") {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Rng rng(seed);
    CourseBook book(kSelf, kRules);
    const Vec2 place_m = random_vector(rng, 0.5);
    book.set_place(place_m);
    struct Message {
      DrivingCourse course;
      Time at{};
    };
    std::map<RobotId, Message> latest;
    Time now = kNow;
    for (int step = 0; step < 400; ++step) {
      CAPTURE(seed, step);
      now += from_seconds(rng.uniform(0, 0.2));
      const auto robot = static_cast<RobotId>(rng.below(6));
      DrivingCourse course = driving(robot, rng, now - from_seconds(rng.uniform(0, 0.5)));
      if (rng.chance(0.2)) course.states.clear();
      hear(book, course, now);
      const auto known = latest.find(robot);
      const bool is_late = known != latest.end() && now - known->second.at <= 1500ms &&
                           course.planned_at < known->second.course.planned_at;
      if (!is_late) latest[robot] = {course, now};
      const double horizon_m = rng.uniform(0, 7);
      std::map<RobotId, Time> expected, found;
      for (const auto& [other, message] : latest)
        if (other != kSelf && !message.course.is_empty() && now - message.at <= 1500ms &&
            (message.course.position_at(now) - place_m).norm() <= horizon_m)
          expected[other] = message.course.planned_at;
      for (const DrivingCourse* nearby : book.nearby(place_m, horizon_m, now))
        found[nearby->robot] = nearby->planned_at;
      REQUIRE(found == expected);
    }
  }
}

}  // namespace sidestep::course_book_test
