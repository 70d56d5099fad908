// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/metrics/floor_recorder.hpp"

#include "common/config/scenario_loader.hpp"
#include "tests/catch.hpp"

namespace sidestep::floor_recorder_test {

const Scenario kTwo = parse_scenario(
    "robots:\n"
    "- {id: 3, start_m: [0, 0], goals_m: [[1, 0]]}\n"
    "- {id: 7, team: yellow, start_m: [0, 1], goals_m: [[0.5, 1], [2, 1]]}\n"
    "obstacles:\n"
    "- circle: {centre_m: [3, 0], radius_m: 0.4}\n",
    "two.yaml");

constexpr Time kBegin = time_from_ns(1'000'000'000'000);

Time after(double seconds) { return kBegin + from_seconds(seconds); }

msg::GroundTruth truth(std::uint64_t number, double at_s, std::uint64_t incarnation = 1) {
  msg::GroundTruth message;
  message.header().incarnation(incarnation);
  message.header().message_number(number);
  message.valid_at_ns(to_ns(after(at_s)));
  return message;
}

void set_contact(msg::GroundTruth& message, std::uint64_t number, RobotId first, RobotId second) {
  msg::ContactPair pair;
  pair.first(first);
  pair.second(second);
  message.recent_contacts()[number % msg::MAX_CONTACTS] = pair;
}

TEST_CASE("a trace has the floor, the robots' starts and goals, and their paths since the first grant") {
  FloorRecorder recorder(kTwo);
  recorder.place(0, {after(-1), {0, 0}, 0});
  recorder.place(0, {after(2), {1, 0}, 0.5});
  recorder.place(1, {after(2), {0, 1}, 0});
  const FloorTrace trace = recorder.trace(after(0));
  CHECK(trace.zero == after(0));
  CHECK(trace.radius_m == kTwo.radius_m);
  CHECK(trace.speed_limit_mps == kTwo.limits.speed_mps);
  CHECK(trace.obstacles.size() == 1);
  REQUIRE(trace.robots.size() == 2);
  CHECK(trace.robots[0].id == 3);
  CHECK(trace.robots[1].team == Team::kYellow);
  CHECK(trace.robots[1].goals_m == std::vector<Vec2>{{0.5, 1}, {2, 1}});
  REQUIRE(trace.robots[0].path.size() == 2);
  CHECK(trace.robots[0].path[0].at_s == Approx(-1));
  CHECK(trace.robots[0].path[1].at_s == Approx(2));
  CHECK(trace.robots[0].path[1].speed_mps == 0.5);
}

TEST_CASE("if nothing was granted, times count from the first time that a robot was seen") {
  FloorRecorder recorder(kTwo);
  recorder.place(0, {after(5), {0, 0}, 0});
  recorder.place(1, {after(4), {0, 1}, 0});
  const FloorTrace trace = recorder.trace(std::nullopt);
  CHECK(trace.zero == after(4));
  CHECK(trace.robots[0].path[0].at_s == Approx(1));
}

TEST_CASE("contacts and crashes are recorded once each, with robots, time and place") {
  FloorRecorder recorder(kTwo);
  recorder.on_truth(truth(1, 0));
  recorder.place(0, {after(1), {0.4, 0.2}, 1});
  msg::GroundTruth second = truth(2, 1);
  second.contacts(1);
  set_contact(second, 0, 3, 7);
  recorder.on_truth(second);
  recorder.on_truth(second);
  msg::GroundTruth third = truth(3, 2);
  third.contacts(2);
  set_contact(third, 0, 3, 7);
  set_contact(third, 1, 7, msg::NO_ROBOT);
  third.crashes_while_moving(1);
  third.recent_moving_crashes()[0] = 3;
  recorder.on_truth(third);
  const std::vector<FloorTrace::Incident> incidents = recorder.trace(after(0)).incidents;
  REQUIRE(incidents.size() == 3);
  CHECK(incidents[0].kind == FloorTrace::kContact);
  CHECK(incidents[0].robots == std::vector<RobotId>{3, 7});
  CHECK(incidents[0].at_s == Approx(1));
  CHECK(incidents[0].position_m == Vec2(0.4, 0.2));
  CHECK(incidents[1].robots == std::vector<RobotId>{7});
  CHECK(incidents[1].position_m == Vec2(0, 1));  // not seen yet: the start
  CHECK(incidents[2].kind == FloorTrace::kCrash);
  CHECK(incidents[2].robots == std::vector<RobotId>{3});
}

TEST_CASE("a restarted simulator counts contacts from zero") {
  FloorRecorder recorder(kTwo);
  msg::GroundTruth first = truth(1, 0);
  first.contacts(1);
  set_contact(first, 0, 3, 7);
  recorder.on_truth(first);
  msg::GroundTruth restarted = truth(1, 5, 2);
  restarted.contacts(1);
  set_contact(restarted, 0, 7, 3);
  recorder.on_truth(restarted);
  CHECK(recorder.trace(after(0)).incidents.size() == 2);
}

TEST_CASE("endless contacts fill the trace up to its limit, and those that no message lists are left out") {
  FloorRecorder recorder(kTwo);
  msg::GroundTruth many = truth(1, 0);
  for (std::uint64_t k = 0; k < msg::MAX_CONTACTS; ++k) set_contact(many, k, 3, 7);
  for (std::uint64_t i = 1; i <= 100; ++i) {
    many.contacts(1'000'000 * i);
    recorder.on_truth(many);
  }
  CHECK(recorder.trace(after(0)).incidents.size() == FloorRecorder::kMaxIncidents);
}

TEST_CASE("the begin of the opponents' motion follows from the numbers of the messages") {
  FloorRecorder recorder(kTwo);
  CHECK_FALSE(recorder.trace(after(0)).opponents_since_s);
  // The first two messages were missed; one comes every 20 ms.
  recorder.on_truth(truth(3, 0.54));
  CHECK_FALSE(recorder.trace(after(0)).opponents_since_s);
  recorder.on_truth(truth(13, 0.74));
  recorder.on_truth(truth(1, 9, 2));  // of a restarted simulator
  REQUIRE(recorder.trace(after(0)).opponents_since_s);
  CHECK(*recorder.trace(after(0)).opponents_since_s == Approx(0.5));
}

}  // namespace sidestep::floor_recorder_test
