// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/monitor/floor_frame.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

#include "common/config/scenario_loader.hpp"
#include "common/messaging/course_codec.hpp"
#include "common/protocol/senders.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "deploy/view/monitor/panels.hpp"
#include "tests/catch.hpp"
#include "tests/unit/deploy/view/monitor/straight_course.hpp"

namespace sidestep::floor_frame_test {

using namespace std::chrono_literals;

constexpr Time kNow = time_from_ns(1'800'000'000'000'000'000);

/// The rows of a section, as a viewer reads them.
std::vector<std::map<std::string, double>> rows_of(const std::string& frame, const std::string& section) {
  const nlohmann::ordered_json sections = frame_layout().at("sections");
  std::vector<std::map<std::string, double>> rows;
  std::size_t at = 12 + 4 * sections.size();
  for (std::size_t i = 0; i < sections.size(); ++i) {
    std::uint32_t count = 0;
    std::memcpy(&count, frame.data() + 12 + 4 * i, sizeof count);
    for (std::uint32_t row = 0; row < count; ++row) {
      std::map<std::string, double> values;
      for (const auto& column : sections[i].at("columns")) {
        float value = 0;
        std::memcpy(&value, frame.data() + at, sizeof value);
        values[column.get<std::string>()] = static_cast<double>(value);
        at += sizeof value;
      }
      if (sections[i].at("name") == section) rows.push_back(values);
    }
  }
  REQUIRE(at == frame.size());
  return rows;
}

/// A course as a coordinator relays it.
msg::Course relayed(const DrivingCourse& course) {
  msg::Course message = encode(course);
  message.header().sender(static_cast<std::uint32_t>(Sender::kCoordinator));
  return message;
}

struct Floor {
  std::size_t shown(Time now) const { return rows_of(encode_frame(state, {}, now), "courses").size(); }
  FloorState state;
};

TEST_CASE("a course is shown from now on, every half second and at its end") {
  Floor floor;
  floor.state.on(relayed(straight_course(3, kNow, 0s, {0, 2}, {1, 0}, 1200ms)), kNow);
  const auto rows = rows_of(encode_frame(floor.state, {}, kNow + 100ms), "courses");
  REQUIRE(rows.size() == 4);
  constexpr std::array kAhead_s{0.0, 0.5, 1.0, 1.1};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    CAPTURE(i);
    CHECK(rows[i].at("robot") == 3);
    CHECK(rows[i].at("ahead") == Approx(kAhead_s[i]).margin(1e-6));
    CHECK(rows[i].at("x") == Approx(0.1 + kAhead_s[i]).margin(1e-5));
    CHECK(rows[i].at("y") == Approx(2));
    CHECK(rows[i].at("vx") == Approx(i < 3 ? 1 : 0).margin(1e-5));
    CHECK(rows[i].at("vy") == Approx(0).margin(1e-5));
  }
  // The page has a mark where this is a whole number.
  CHECK(rows[2].at("ahead") == 1);
}

TEST_CASE(
    "a course is shown until an empty one replaces it, it is over, or it has not been repeated for 1.5 s") {
  const DrivingCourse course = straight_course(3, kNow, 0s, {0, 0}, {1, 0}, 3s);
  DrivingCourse none;
  none.robot = 3;
  none.planned_at = kNow + 1ns;
  Floor floor;
  CHECK(floor.shown(kNow) == 0);
  floor.state.on(relayed(course), kNow);
  CHECK(floor.shown(kNow + 1500ms) > 0);
  CHECK(floor.shown(kNow + 1500ms + 1ns) == 0);
  floor.state.on(relayed(course), kNow + 1400ms);
  CHECK(floor.shown(kNow + 2900ms) > 0);
  floor.state.on(relayed(course), kNow + 2900ms);
  CHECK(floor.shown(kNow + 3s) == 0);
  floor.state.on(relayed(none), kNow + 2900ms);
  CHECK(floor.shown(kNow + 2900ms) == 0);
}

TEST_CASE(
    "courses that start long before or after they arrive are not shown, and none after the clock is set "
    "back") {
  const auto is_shown = [](Duration later, Duration seen_after) {
    Floor floor;
    floor.state.on(relayed(straight_course(3, kNow + later, 0s, {0, 0}, {1, 0}, 3s)), kNow);
    return floor.shown(kNow + seen_after) > 0;
  };
  CHECK(is_shown(4s, 0s));
  CHECK_FALSE(is_shown(6s, 0s));
  CHECK_FALSE(is_shown(-61s, 0s));
  CHECK_FALSE(is_shown(0s, -2s));
}

TEST_CASE("a course that was planned earlier, or that no coordinator has relayed, is not shown") {
  const DrivingCourse course = straight_course(3, kNow, 0s, {0, 0}, {1, 0}, 3s);
  Floor floor;
  floor.state.on(encode(course), kNow);
  CHECK(floor.shown(kNow) == 0);
  DrivingCourse none;
  none.robot = 3;
  none.planned_at = kNow + 1ns;
  floor.state.on(relayed(none), kNow);
  floor.state.on(relayed(course), kNow);
  CHECK(floor.shown(kNow) == 0);
  // A record of a robot that is silent does not count: its clock may have been set back.
  floor.state.on(relayed(course), kNow + 1600ms);
  CHECK(floor.shown(kNow + 1600ms) > 0);
}

TEST_CASE("frames and panels say for whom a robot waits, and a lower speed limit is considered") {
  Floor floor;
  floor.state.on(relayed(straight_course(0, kNow, 1s, {0, 0}, {2, 0}, 1s)), kNow);
  floor.state.on(relayed(straight_course(1, kNow, 0s, {1, -1}, {0, 2}, 1s)), kNow);
  FloorRules rules;
  rules.limits.speed_mps = 2;
  const Waits waits = waits_on(floor.state, rules, kNow);
  CHECK(waits == Waits{{0, 1}});
  const auto rows = rows_of(encode_frame(floor.state, waits, kNow), "robots");
  REQUIRE(rows.size() == 2);
  CHECK(rows[0].at("waits_for") == 1);
  CHECK(std::isnan(rows[1].at("waits_for")));
  const auto json = robots_json(floor.state, waits, kNow);
  CHECK(json.at(0).at("waits_for") == 1);
  CHECK_FALSE(json.at(1).contains("waits_for"));
  msg::AgentStatus status;
  status.robot(0);
  status.clock_speed_limit_mps(0.5);
  floor.state.on(status, kNow);
  CHECK(waits_on(floor.state, rules, kNow).empty());
}

TEST_CASE("the courses of a run begin where its robots are") {
  const Scenario scenario = load_scenario(SIDESTEP_SOURCE_DIR "/deploy/scenarios/crossing.yaml");
  SimSystem system(scenario, 1);
  FloorState floor;
  Bus& bus = system.observer_bus();
  bus.subscribe(topics::kSharedCourse, [&](const msg::Course& m) { floor.on(m, bus.now()); });
  bus.subscribe(topics::kTruth, [&](const msg::GroundTruth& m) { floor.on(m, bus.now()); });
  int courses = 0;
  for (int i = 0; i < 20; ++i) {
    system.run_for(100ms);
    const std::string frame = encode_frame(floor, {}, bus.now());
    const auto robots = rows_of(frame, "robots");
    for (const auto& row : rows_of(frame, "courses")) {
      if (row.at("ahead") != 0) continue;
      ++courses;
      for (const auto& robot : robots)
        if (robot.at("id") == row.at("robot"))
          CHECK(std::hypot(robot.at("true_x") - row.at("x"), robot.at("true_y") - row.at("y")) < 0.2);
    }
  }
  CHECK(courses > 20);
}

}  // namespace sidestep::floor_frame_test
