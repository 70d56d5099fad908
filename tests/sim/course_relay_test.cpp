// SPDX-License-Identifier: Apache-2.0
// Courses and offers on their way from agents by the active coordinator to all agents.
#include <map>
#include <utility>

#include "common/config/scenario_loader.hpp"
#include "common/messaging/course_codec.hpp"
#include "tests/catch.hpp"
#include "tests/drops.hpp"
#include "tests/sim/ideal_floor.hpp"

namespace sidestep::course_relay_test {

constexpr RobotId kSender = 2, kOther = 3;

Scenario circle_of_five() {
  return parse_scenario(
      "coordinators: 2\nfield: {length_m: 8, width_m: 8}\ncircle: {count: 5, spacing_m: 0.8}\n",
      "circle.yaml");
}

/// A process that publishes courses and offers as the agent of kSender, and records which of all courses and
/// offers reach the floor's agents. Messages are known by the time at which their course was planned.
class CourseTrace {
 public:
  explicit CourseTrace(IdealFloor& floor)
      : floor_(floor),
        courses_(bus_.advertise(topics::kCourse)),
        offers_(bus_.advertise(topics::kCourseOffer)),
        shared_courses_(bus_.advertise(topics::kSharedCourse)) {
    observer_.become_observer();
    observe(topics::kSharedCourse);
    observe(topics::kSharedCourseOffer);
    for (const RobotSpec& robot : floor.scenario.robots) {
      floor.agent_buses(robot.id).front()->watch_headers(
          [this, id = robot.id](const TopicInfo& topic, const msg::Header& header) {
            const auto relayed = relayed_.find({topic.name, {header.sender(), header.message_number()}});
            if (relayed != relayed_.end()) ++received_[id][relayed->second];
          });
    }
  }

  /// Publishes a course of a robot. Returns when it was planned.
  Time publish_course(RobotId robot) { return publish(courses_, encode(course_of(robot))); }
  Time publish_offer(RobotId by) { return publish(offers_, encode(CourseOffer{course_of(kOther), {}, by})); }
  /// Publishes a course on the topic of coordinators.
  void publish_as_relayed() { publish(shared_courses_, encode(course_of(kSender))); }

  /// How many messages with this time of planning have reached the robot's agent from coordinators.
  int received(RobotId robot, Time planned_at) { return received_[robot][to_ns(planned_at)]; }
  /// The number of messages with this time of planning that coordinators have published, and the sender of
  /// the latest message of them.
  int relayed(Time planned_at) { return published_[to_ns(planned_at)].first; }
  std::uint32_t relayed_by(Time planned_at) { return published_[to_ns(planned_at)].second; }

 private:
  DrivingCourse course_of(RobotId robot) const {
    DrivingCourse course;
    course.robot = robot;
    // Unlike the times at which the floor's agents plan, which are those of their control cycles.
    course.planned_at = course.start = floor_.network.now() + Duration{7};
    course.states = {{{3, 3}, {0, 0}}};
    return course;
  }
  template <typename Message>
  Time publish(Writer<Message>& writer, Message message) {
    message.header().sender(kSender);
    writer.publish(message, floor_.network.now());
    (void)floor_.run(0.02);
    return time_from_ns(message.planned_at_ns());
  }
  template <typename Message>
  void observe(const Topic<Message>& topic) {
    observer_.subscribe(topic, [this, name = std::string(topic.name)](const Message& message) {
      const auto& header = message.header();
      relayed_[{name, {header.sender(), header.message_number()}}] = message.planned_at_ns();
      auto& [count, sender] = published_[message.planned_at_ns()];
      ++count;
      sender = header.sender();
    });
  }

  IdealFloor& floor_;
  SimBus bus_{floor_.network}, observer_{floor_.network};
  Writer<msg::Course> courses_;
  Writer<msg::CourseOffer> offers_;
  Writer<msg::Course> shared_courses_;
  /// Times of planning by topic, sender and message number.
  std::map<std::pair<std::string, std::pair<std::uint32_t, std::uint64_t>>, std::int64_t> relayed_;
  std::map<std::int64_t, std::pair<int, std::uint32_t>> published_;
  std::map<RobotId, std::map<std::int64_t, int>> received_;
};

/// Publishes a course and an offer, and requires that this coordinator alone relays each to all agents, once.
void check_relayed(IdealFloor& floor, CourseTrace& trace, CoordinatorNumber coordinator) {
  REQUIRE(floor.granting_coordinator() == static_cast<int>(coordinator));
  for (const Time planned_at : {trace.publish_course(kSender), trace.publish_offer(kSender)}) {
    CHECK(trace.relayed(planned_at) == 1);
    CHECK(trace.relayed_by(planned_at) == process_of(coordinator));
    for (const RobotSpec& robot : floor.scenario.robots) {
      CAPTURE(robot.id);
      CHECK(trace.received(robot.id, planned_at) == 1);
    }
  }
}

TEST_CASE("courses and offers reach all agents once, also after the standby has taken over") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  IdealFloor floor(circle_of_five(), seed);
  CourseTrace trace(floor);
  REQUIRE(floor.run_until_speed(0.5));
  check_relayed(floor, trace, 0);
  floor.kill_coordinator(0);
  const Time lost = trace.publish_course(kSender);
  CHECK(trace.relayed(lost) == 0);
  for (int i = 0; i < 20 && floor.granting_coordinator() != 1; ++i) (void)floor.run(0.05);
  check_relayed(floor, trace, 1);
  // A restarted coordinator stands by.
  floor.start_coordinator(0);
  (void)floor.run(0.2);
  check_relayed(floor, trace, 1);
  CHECK(floor.violations() == 0);
}

TEST_CASE("a course or an offer in the name of another robot is not relayed") {
  IdealFloor floor(circle_of_five(), 1);
  CourseTrace trace(floor);
  REQUIRE(floor.run_until_speed(0.5));
  CHECK(trace.relayed(trace.publish_course(kOther)) == 0);
  CHECK(trace.relayed(trace.publish_offer(kOther)) == 0);
  check_relayed(floor, trace, 0);
}

TEST_CASE("agents ignore courses that an agent publishes on the coordinators' topic") {
  IdealFloor floor(circle_of_five(), 1);
  CourseTrace trace(floor);
  REQUIRE(floor.run_until_speed(0.5));
  const auto refused = [&](RobotId robot) {
    return drops_of(*floor.agent_buses(robot).front()).total(DropReason::kForgedSender);
  };
  trace.publish_as_relayed();
  for (const RobotSpec& robot : floor.scenario.robots) CHECK(refused(robot.id) == 1);
  check_relayed(floor, trace, 0);
}

TEST_CASE("the courses that robots follow reach the agents of all other robots") {
  IdealFloor floor(circle_of_five(), 1);
  SimBus observer(floor.network);
  observer.become_observer();
  std::map<RobotId, std::int64_t> planned;
  observer.subscribe(topics::kCourse,
                     [&](const msg::Course& m) { planned.emplace(m.robot(), m.planned_at_ns()); });
  CourseTrace trace(floor);
  REQUIRE(floor.run_until_speed(0.5));
  (void)floor.run(0.5);
  for (const RobotSpec& sender : floor.scenario.robots) {
    REQUIRE(planned.contains(sender.id));
    for (const RobotSpec& robot : floor.scenario.robots) {
      CAPTURE(sender.id, robot.id);
      CHECK(trace.received(robot.id, time_from_ns(planned[sender.id])) > 0);
    }
  }
}

TEST_CASE("agents plan courses after the verdict, so that neither their proposals nor their robots wait") {
  IdealFloor floor(circle_of_five(), 1);
  SimBus observer(floor.network);
  observer.become_observer();
  std::map<RobotId, std::uint64_t> proposed, judged;  // numbers of the last proposals
  observer.subscribe(topics::kProposal, [&](const msg::Proposal& m) {
    proposed[m.robot()] = m.candidates()[0].version_number();
  });
  for (const RobotSpec& robot : floor.scenario.robots)
    observer.subscribe(topics::kVerdict, robot.id,
                       [&](const msg::Verdict& m) { judged[m.robot()] = m.proposal_number(); });
  int courses = 0;
  observer.subscribe(topics::kCourse, [&](const msg::Course& m) {
    CAPTURE(m.robot());
    CHECK(judged[m.robot()] == proposed[m.robot()]);
    ++courses;
  });
  REQUIRE(floor.run_until_speed(0.5));
  (void)floor.run(2);
  CHECK(courses > 10);
}

}  // namespace sidestep::course_relay_test
