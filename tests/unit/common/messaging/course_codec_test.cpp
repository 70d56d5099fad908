// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/course_codec.hpp"

#include <limits>

#include "common/geometry/coordinate_bound.hpp"
#include "common/messaging/topics.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/messaging/random_messages.hpp"

namespace sidestep::course_codec_test {

using namespace random_messages;
using namespace std::chrono_literals;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr auto kCoordinator = static_cast<std::uint32_t>(Sender::kCoordinator);

/// An offer of five points by the agent of any robot.
CourseOffer random_offer(Rng& rng) {
  return {random_course(rng, 5), random_time(rng), static_cast<RobotId>(rng.below(kMaxRobots))};
}

void require_equal(const DrivingCourse& a, const DrivingCourse& b) {
  REQUIRE(a.robot == b.robot);
  REQUIRE(a.planned_at == b.planned_at);
  REQUIRE(a.due == b.due);
  REQUIRE(a.start == b.start);
  REQUIRE(a.continues == b.continues);
  REQUIRE(a.states.size() == b.states.size());
  for (std::size_t i = 0; i < a.states.size(); ++i) {
    REQUIRE(a.states[i].position_m == b.states[i].position_m);
    REQUIRE(a.states[i].velocity_mps == b.states[i].velocity_mps);
  }
}

/// The message after a bus has delivered it; nullopt if the bus refuses it.
template <typename Message>
std::optional<Message> delivered(const Topic<Message>& topic, const Message& message) {
  std::vector<std::uint8_t> bytes;
  append_cdr(topic, &message, bytes);
  std::optional<Message> result;
  const bool is_read =
      read_cdr(topic, bytes, [&](const void* read) { result = *static_cast<const Message*>(read); });
  CHECK(is_read == result.has_value());
  return result;
}

TEST_CASE("a course of any length survives encoding and decoding") {
  const std::uint64_t seed = GENERATE(1, 2, 3);
  CAPTURE(seed);
  Rng rng(seed);
  for (std::size_t points = 1; points <= msg::MAX_COURSE_POINTS; points += 1 + points / 4) {
    const DrivingCourse course = random_course(rng, points);
    const auto message = delivered(topics::kCourse, encode(course));
    REQUIRE(message);
    const auto decoded = decode(*message, kNow);
    REQUIRE(decoded);
    require_equal(*decoded, course);
  }
  const DrivingCourse longest = random_course(rng, msg::MAX_COURSE_POINTS);
  const auto decoded = decode(encode(longest), kNow);
  REQUIRE(decoded);
  require_equal(*decoded, longest);
}

TEST_CASE("an offer survives encoding and decoding, with the robot whose agent offers it") {
  const std::uint64_t seed = GENERATE(1, 2, 3);
  CAPTURE(seed);
  Rng rng(seed);
  for (int i = 0; i < 1000; ++i) {
    const CourseOffer offer = random_offer(rng);
    const auto message = delivered(topics::kCourseOffer, encode(offer));
    REQUIRE(message);
    const auto decoded = decode(*message, kNow);
    REQUIRE(decoded);
    require_equal(decoded->course, offer.course);
    REQUIRE(decoded->replaces == offer.replaces);
    REQUIRE(decoded->by == offer.by);
  }
}

TEST_CASE("of a course without points only the robot and the time of planning matter") {
  DrivingCourse none;
  none.robot = kRobot;
  none.planned_at = kNow;
  msg::Course message = encode(none);
  message.due_ns(std::numeric_limits<std::int64_t>::max());
  message.start_ns(std::numeric_limits<std::int64_t>::min());
  const auto course = decode(message, kNow);
  REQUIRE(course);
  CHECK(course->is_empty());
  CHECK(course->robot == kRobot);
  CHECK(course->planned_at == kNow);
  CHECK(course->due == Time{});
  CHECK(course->start == Time{});
  message.planned_at_ns(0);
  CHECK_FALSE(decode(message, kNow));
  message.planned_at_ns(to_ns(kNow));
  message.header().sender(kRobot + 1);
  CHECK_FALSE(decode(message, kNow));
}

TEST_CASE("an offer without points is refused") {
  Rng rng(1);
  CourseOffer offer = random_offer(rng);
  REQUIRE(decode(encode(offer), kNow));
  offer.course.states.clear();
  CHECK_FALSE(decode(encode(offer), kNow));
}

TEST_CASE("a course is refused unless an agent of its robot or a coordinator sent it") {
  Rng rng(1);
  msg::Course message = encode(random_course(rng, 3));
  REQUIRE(decode(message, kNow));
  for (const std::uint32_t sender :
       {kRobot + 1, kMaxRobots, kCoordinator - 1, kCoordinator + kMaxCoordinators,
        static_cast<std::uint32_t>(Sender::kOperator), std::numeric_limits<std::uint32_t>::max()}) {
    CAPTURE(sender);
    message.header().sender(sender);
    CHECK_FALSE(decode(message, kNow));
  }
  for (const std::uint32_t sender : {kCoordinator, kCoordinator + kMaxCoordinators - 1}) {
    CAPTURE(sender);
    message.header().sender(sender);
    const auto course = decode(message, kNow);
    REQUIRE(course);
    CHECK(course->robot == kRobot);
  }
  message.robot(kMaxRobots - 1);
  message.header().sender(kMaxRobots - 1);
  CHECK(decode(message, kNow));
  message.robot(kMaxRobots);
  for (const std::uint32_t sender : {kMaxRobots, kCoordinator}) {
    message.header().sender(sender);
    CHECK_FALSE(decode(message, kNow));
  }
}

TEST_CASE("an offer is refused unless the agent that offers it or a coordinator sent it for a robot") {
  Rng rng(1);
  msg::CourseOffer message = encode(random_offer(rng));
  for (const RobotId by : {0U, kRobot, kRobot + 1, kMaxRobots - 1}) {
    message.by(by);
    for (const std::uint32_t sender : {by, kCoordinator, kCoordinator + kMaxCoordinators - 1}) {
      CAPTURE(by, sender);
      message.header().sender(sender);
      const auto offer = decode(message, kNow);
      REQUIRE(offer);
      CHECK(offer->by == by);
      CHECK(offer->course.robot == kRobot);
    }
    for (const std::uint32_t sender :
         {by + 1, kCoordinator - 1, kCoordinator + kMaxCoordinators,
          static_cast<std::uint32_t>(Sender::kClient), std::numeric_limits<std::uint32_t>::max()}) {
      CAPTURE(by, sender);
      message.header().sender(sender);
      CHECK_FALSE(decode(message, kNow));
    }
  }
  for (const RobotId by : {kMaxRobots, kCoordinator, std::numeric_limits<RobotId>::max()}) {
    message.by(by);
    for (const std::uint32_t sender : {by, kCoordinator}) {
      CAPTURE(by, sender);
      message.header().sender(sender);
      CHECK_FALSE(decode(message, kNow));
    }
  }
  message.by(kRobot);
  message.header().sender(kRobot);
  for (const RobotId robot : {kMaxRobots, std::numeric_limits<RobotId>::max()}) {
    message.robot(robot);
    CHECK_FALSE(decode(message, kNow));
  }
}

/// Checks courses and offers, whose members have the same names.
template <typename Spoil>
void check_refused(Spoil spoil) {
  Rng rng(6);
  msg::Course course = encode(random_course(rng, 5));
  msg::CourseOffer offer = encode(random_offer(rng));
  REQUIRE(decode(course, kNow));
  REQUIRE(decode(offer, kNow));
  spoil(course);
  spoil(offer);
  CHECK_FALSE(decode(course, kNow));
  CHECK_FALSE(decode(offer, kNow));
}

template <typename Change>
void check_accepted(Change change) {
  Rng rng(6);
  msg::Course course = encode(random_course(rng, 5));
  msg::CourseOffer offer = encode(random_offer(rng));
  change(course);
  change(offer);
  CHECK(decode(course, kNow));
  CHECK(decode(offer, kNow));
}

TEST_CASE("a course with an implausible time is refused") {
  constexpr std::int64_t kLowest = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kHighest = std::numeric_limits<std::int64_t>::max();
  const std::int64_t ahead = to_ns(kNow + 1h);
  for (const std::int64_t time : {kLowest, std::int64_t{-1}, ahead, kHighest}) {
    CAPTURE(time);
    check_refused([=](auto& m) { m.planned_at_ns(time); });
    check_refused([=](auto& m) { m.due_ns(time); });
    check_refused([=](auto& m) { m.start_ns(time); });
    Rng rng(6);
    msg::CourseOffer offer = encode(random_offer(rng));
    offer.replaces_ns(time);
    CHECK_FALSE(decode(offer, kNow));
  }
  check_refused([](auto& m) { m.planned_at_ns(0); });
  check_accepted([=](auto& m) { m.planned_at_ns(ahead - 1), m.due_ns(ahead - 1); });
  check_accepted([](auto& m) { m.planned_at_ns(1), m.due_ns(0); });
}

TEST_CASE("a course with a number that is not finite or too large is refused, at any point") {
  const std::size_t point = GENERATE(0, 2, 4);
  CAPTURE(point);
  for (const float bad : {kNan, kInfinity, -kInfinity, 1e30F}) {
    CAPTURE(bad);
    check_refused([=](auto& m) { m.points()[point].x_m(bad); });
    check_refused([=](auto& m) { m.points()[point].y_m(bad); });
    check_refused([=](auto& m) { m.points()[point].vx_mps(bad); });
    check_refused([=](auto& m) { m.points()[point].vy_mps(bad); });
  }
  for (const float speed : {101.0F, -101.0F}) {
    check_refused([=](auto& m) { m.points()[point].vx_mps(speed); });
    check_refused([=](auto& m) { m.points()[point].vy_mps(speed); });
  }
}

TEST_CASE("a course beyond the largest coordinate is refused") {
  const auto move_to = [](float x_m, float y_m) {
    return [=](auto& m) {
      for (msg::CoursePoint& point : m.points()) point.x_m(x_m), point.y_m(y_m);
    };
  };
  constexpr auto kEdge = static_cast<float>(kMaxCoordinate_m);
  for (const float side : {-1.0F, 1.0F}) {
    check_accepted(move_to(side * kEdge, side * kEdge));
    check_refused(move_to(side * (kEdge + 1), 0));
    check_refused(move_to(0, side * (kEdge + 1)));
  }
}

TEST_CASE("a course that does not end at rest is refused") {
  check_refused([](auto& m) { m.points().back().vx_mps(1e-30F); });
  check_refused([](auto& m) { m.points().back().vy_mps(-0.001F); });
  check_refused([](auto& m) { m.points().pop_back(), m.points().back().vx_mps(1); });
  check_accepted([](auto& m) { m.points().back().vx_mps(-0.0F); });
}

TEST_CASE("a course whose points are farther apart than the largest speed allows is refused") {
  const std::size_t point = GENERATE(0, 2, 4);
  CAPTURE(point);
  const auto place = [=](double distance_m) {
    return [=](auto& m) {
      for (msg::CoursePoint& other : m.points()) other.x_m(0), other.y_m(0);
      // 0.6² + 0.8² = 1.
      m.points()[point].x_m(static_cast<float>(0.6 * distance_m));
      m.points()[point].y_m(static_cast<float>(-0.8 * distance_m));
    };
  };
  const double sample_s = to_seconds(DrivingCourse::kSample);
  check_accepted(place(99 * sample_s));
  check_refused(place(101 * sample_s));
  check_refused(place(200 * sample_s));
}

TEST_CASE("more points than the bound are refused") {
  Rng rng(7);
  const auto check = [](auto message) {
    REQUIRE(decode(message, kNow));
    message.points().push_back(message.points().back());
    REQUIRE(message.points().size() == msg::MAX_COURSE_POINTS + 1);
    CHECK_FALSE(decode(message, kNow));
  };
  const DrivingCourse course = random_course(rng, msg::MAX_COURSE_POINTS);
  check(encode(course));
  check(encode(CourseOffer{course, kNow, kRobot}));
}

}  // namespace sidestep::course_codec_test
