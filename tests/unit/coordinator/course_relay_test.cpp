// SPDX-License-Identifier: Apache-2.0
#include "coordinator/course_relay.hpp"

#include "common/messaging/course_codec.hpp"
#include "common/messaging/sim/bus.hpp"
#include "tests/unit/coordinator/coordinator_fixture.hpp"

namespace sidestep::course_relay_test {

using coordinator_test::kEpoch;
using coordinator_test::kNow;

constexpr CoordinatorIdentity kSelf{1, 5};
constexpr RobotId kUnknown = 7;  ///< a robot that is not on the roster

DrivingCourse course_of(RobotId robot) {
  DrivingCourse course;
  course.robot = robot;
  course.planned_at = kNow;
  course.due = kNow + Duration{2};
  course.start = kNow + Duration{3};
  course.continues = true;
  course.states = {{{1, 2}, {0.5, 0}}, {{1.0125, 2}, {0, 0}}};
  return course;
}

/// A relay of a coordinator of the robots 1 and 2, and a process that stands for all agents.
struct Floor : coordinator_test::Floor {
  Floor() {
    agents.subscribe(topics::kSharedCourse, [this](const msg::Course& m) { courses.push_back(m); });
    agents.subscribe(topics::kSharedCourseOffer, [this](const msg::CourseOffer& m) { offers.push_back(m); });
  }
  template <typename Message>
  void send(const Topic<Message>& topic, Message message) {
    auto writer = agents.advertise(topic);
    writer.publish(message, network.now());
    network.run_until(network.now() + std::chrono::milliseconds(10));
  }
  void send(const DrivingCourse& course) { send(topics::kCourse, encode(course)); }
  void send(const CourseOffer& offer) { send(topics::kCourseOffer, encode(offer)); }
  bool has_relayed() const { return !courses.empty() || !offers.empty(); }

  SimNetwork network{1, kNow, {}};
  SimBus bus{network}, agents{network};
  CourseRelay relay{bus, kSelf, coordinator, std::chrono::milliseconds(20)};
  std::vector<msg::Course> courses;
  std::vector<msg::CourseOffer> offers;
};

void require_from_coordinator(const msg::Header& header) {
  CHECK(header.sender() == process_of(kSelf.number));
  CHECK(header.incarnation() == kSelf.incarnation);
  CHECK(header.message_number() == 1);
}

TEST_CASE("a granting coordinator relays a course, unchanged but for the header") {
  Floor floor;
  floor.register_both();
  const DrivingCourse course = course_of(1);
  floor.send(course);
  REQUIRE(floor.courses.size() == 1);
  msg::Course relayed = floor.courses.front(), expected = encode(course);
  require_from_coordinator(relayed.header());
  relayed.header() = expected.header();
  CHECK(relayed == expected);
  CHECK(floor.offers.empty());
  CHECK(floor.relay.drops().total() == 0);
}

TEST_CASE("a granting coordinator relays that a robot has no course") {
  Floor floor;
  floor.register_both();
  DrivingCourse none;
  none.robot = 2;
  none.planned_at = kNow;
  floor.send(none);
  REQUIRE(floor.courses.size() == 1);
  CHECK(floor.courses.front().robot() == 2);
  CHECK(floor.courses.front().points().empty());
}

TEST_CASE("a granting coordinator relays an offer, unchanged but for the header") {
  Floor floor;
  floor.register_both();
  const CourseOffer offer{course_of(2), kNow - Duration{9}, 1};
  floor.send(offer);
  REQUIRE(floor.offers.size() == 1);
  msg::CourseOffer relayed = floor.offers.front(), expected = encode(offer);
  require_from_coordinator(relayed.header());
  relayed.header() = expected.header();
  CHECK(relayed == expected);
  CHECK(floor.courses.empty());
  CHECK(floor.relay.drops().total() == 0);
}

TEST_CASE("courses and offers that start a minute before or five seconds after their arrival are dropped") {
  const auto [later, is_relayed] = GENERATE(table<Duration, bool>({{Duration{-59'000'000'000}, true},
                                                                   {Duration{-61'000'000'000}, false},
                                                                   {Duration{4'900'000'000}, true},
                                                                   {Duration{5'100'000'000}, false}}));
  CAPTURE(to_seconds(later));
  Floor floor;
  floor.register_both();
  DrivingCourse course = course_of(1);
  course.start = kNow + later;
  floor.send(course);
  CHECK(floor.courses.size() == (is_relayed ? 1 : 0));
  CHECK(floor.relay.drops().total(DropReason::kMalformedCourse) == (is_relayed ? 0 : 1));
  course.robot = 2;
  floor.send(CourseOffer{course, kNow - Duration{9}, 1});
  CHECK(floor.offers.size() == (is_relayed ? 1 : 0));
  CHECK(floor.relay.drops().total(DropReason::kMalformedCourseOffer) == (is_relayed ? 0 : 1));
}

TEST_CASE("a coordinator that does not grant relays nothing") {
  Floor floor;
  SECTION("not all robots have registered") { floor.receive(registration_of(floor.a, kEpoch)); }
  SECTION("it stands by") {
    floor.register_both();
    floor.coordinator.begin_epoch(0);
  }
  floor.send(course_of(1));
  floor.send(CourseOffer{course_of(2), kNow, 1});
  CHECK_FALSE(floor.has_relayed());
}

TEST_CASE("malformed courses and offers are counted and not relayed") {
  Floor floor;
  floor.register_both();
  msg::Course course = encode(course_of(1));
  course.robot(2);
  floor.send(topics::kCourse, course);
  CHECK(floor.relay.drops().total(DropReason::kMalformedCourse) == 1);
  msg::CourseOffer offer = encode(CourseOffer{course_of(2), kNow, 1});
  offer.by(2);
  floor.send(topics::kCourseOffer, offer);
  CHECK(floor.relay.drops().total(DropReason::kMalformedCourseOffer) == 1);
  CHECK(floor.relay.drops().total() == 2);
  CHECK_FALSE(floor.has_relayed());
}

TEST_CASE("courses and offers that concern a robot that is not on the roster are counted and not relayed") {
  Floor floor;
  floor.register_both();
  floor.send(course_of(kUnknown));
  floor.send(CourseOffer{course_of(kUnknown), kNow, 1});
  floor.send(CourseOffer{course_of(1), kNow, kUnknown});
  CHECK(floor.relay.drops().total(DropReason::kUnknownRobot) == 3);
  CHECK_FALSE(floor.has_relayed());
}

TEST_CASE("of an agent that sends more than it can plan, a part is relayed, and all of others") {
  Floor floor;
  floor.register_both();
  auto courses = floor.agents.advertise(topics::kCourse);
  auto offers = floor.agents.advertise(topics::kCourseOffer);
  // For 200 ms, ten courses and ten offers in a millisecond.
  for (int ms = 0; ms < 200; ++ms) {
    for (int i = 0; i < 10; ++i) {
      msg::Course course = encode(course_of(1));
      courses.publish(course, floor.network.now());
      msg::CourseOffer offer = encode(CourseOffer{course_of(2), kNow, 1});
      offers.publish(offer, floor.network.now());
    }
    floor.network.run_until(floor.network.now() + std::chrono::milliseconds(1));
  }
  CHECK(floor.courses.size() >= 2 * (100 / 20));
  CHECK(floor.courses.size() <= 3 * (100 / 20 + 2));
  CHECK(floor.offers.size() >= 2 * 4 * (100 / 20));
  CHECK(floor.offers.size() <= 3 * 4 * (100 / 20 + 2));
  CHECK(floor.relay.drops().total(DropReason::kFrequentCourse) > 3000);
  floor.courses.clear();
  floor.send(course_of(2));
  CHECK(floor.courses.size() == 1);
}

TEST_CASE("what coordinators have relayed is not relayed again") {
  Floor floor;
  floor.register_both();
  msg::Course course = encode(course_of(1));
  course.header().sender(process_of(0));
  floor.send(topics::kCourse, course);
  msg::CourseOffer offer = encode(CourseOffer{course_of(2), kNow, 1});
  offer.header().sender(process_of(0));
  floor.send(topics::kCourseOffer, offer);
  CHECK_FALSE(floor.has_relayed());
}

}  // namespace sidestep::course_relay_test
