// SPDX-License-Identifier: Apache-2.0
#include "vision/tracking/frame.hpp"

#include <cmath>
#include <limits>

#include "common/geometry/coordinate_bound.hpp"
#include "tests/catch.hpp"
#include "tests/unit/vision/tracker_fixture.hpp"

namespace sidestep::frame_test {

using namespace sidestep::test;

msg::RobotDetection valid_robot() {
  msg::DetectionFrame frame;
  add_robot(frame, 3, {1, 2}, 0.5);
  return frame.robots()[0];
}

/// Checks that a frame drops and counts `bad`, and keeps a valid detection.
void check_invalid_detection_is_dropped(const msg::RobotDetection& bad) {
  msg::DetectionFrame message = frame_message(0, kBegin);
  message.robots().push_back(bad);
  message.robots().push_back(valid_robot());
  Frame frame;
  frame.assign(message, kBegin);
  CHECK(frame.is_usable());
  REQUIRE(frame.robots().size() == 1);
  CHECK(frame.robots()[0].robot == 3);
  CHECK(frame.robots()[0].position_m == Vec2(1, 2));
  CHECK(frame.rejected() == 1);
}

TEST_CASE("a detection with a NaN or too large number is dropped and counted, and a valid one is kept") {
  const double bad =
      GENERATE(std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
               -std::numeric_limits<double>::infinity(), 1.001 * kMaxCoordinate_m, -1e300);
  CAPTURE(bad);
  msg::RobotDetection d = valid_robot();
  SECTION("x") { d.x_m(bad); }
  SECTION("y") { d.y_m(bad); }
  SECTION("heading") { d.heading_rad(bad); }
  SECTION("confidence") { d.confidence(bad); }
  check_invalid_detection_is_dropped(d);
}

TEST_CASE("a detection with a confidence or robot number out of range is dropped, and a valid one is kept") {
  msg::RobotDetection d = valid_robot();
  SECTION("confidence below 0") { d.confidence(-0.001); }
  SECTION("confidence above 1") { d.confidence(1.001); }
  SECTION("first robot number out of range") { d.robot(kMaxRobots); }
  SECTION("largest robot number") { d.robot(0xffffffff); }
  check_invalid_detection_is_dropped(d);
}

TEST_CASE("invalid balls are dropped and counted, and valid balls are kept") {
  msg::DetectionFrame message = frame_message(0, kBegin);
  add_ball(message, {1, 1});
  add_ball(message, {std::nan(""), 1});
  add_ball(message, {1, 1.001 * kMaxCoordinate_m});
  add_ball(message, {2, 2});
  message.balls()[3].confidence(2);
  Frame frame;
  frame.assign(message, kBegin);
  CHECK(frame.balls().size() == 1);
  CHECK(frame.rejected() == 3);
}

TEST_CASE("detections are kept at every place that other processes accept") {
  const double x_m = GENERATE(-1, 1) * kMaxCoordinate_m, y_m = GENERATE(-1, 1) * kMaxCoordinate_m;
  CAPTURE(x_m, y_m);
  msg::DetectionFrame message = frame_message(0, kBegin);
  add_robot(message, 3, {x_m, y_m}, 0.5);
  add_ball(message, {x_m, y_m});
  add_obstacle(message, {x_m, y_m});
  Frame frame;
  frame.assign(message, kBegin);
  CHECK(frame.rejected() == 0);
  REQUIRE(frame.robots().size() == 1);
  CHECK(frame.robots()[0].position_m == Vec2(x_m, y_m));
  CHECK(frame.balls().size() == 1);
  CHECK(frame.obstacles().size() == 1);
}

TEST_CASE("a frame that is too old or from the future is rejected as a whole") {
  const std::int64_t ns = to_ns(kBegin);
  const std::int64_t captured =
      GENERATE_COPY(ns - 500'000'001, ns + 101'000'001, std::int64_t{0},
                    std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max());
  CAPTURE(captured);
  msg::DetectionFrame message = frame_message(0, kBegin);
  message.captured_at_ns(captured);
  message.robots().push_back(valid_robot());
  message.robots().push_back(valid_robot());
  Frame frame;
  frame.assign(message, kBegin);
  CHECK_FALSE(frame.is_usable());
  CHECK(frame.robots().empty());
  CHECK(frame.rejected() == 2);
}

TEST_CASE("a frame just within the time limits is accepted") {
  const Duration age = GENERATE(Duration{500'000'000}, Duration{-101'000'000});
  msg::DetectionFrame message = frame_message(0, kBegin - age);
  message.robots().push_back(valid_robot());
  Frame frame;
  frame.assign(message, kBegin);
  CHECK(frame.is_usable());
  CHECK(frame.robots().size() == 1);
}

TEST_CASE("the clock bound determines how far a frame may be ahead") {
  const Duration max_lead{250'000'000};
  Frame frame;
  frame.assign(frame_message(0, kBegin + Duration{249'000'000}), kBegin, max_lead);
  CHECK(frame.is_usable());
  frame.assign(frame_message(0, kBegin + Duration{251'000'000}), kBegin, max_lead);
  CHECK_FALSE(frame.is_usable());
}

TEST_CASE("a frame with an invalid obstacle does not count as complete") {
  msg::DetectionFrame message = frame_message(0, kBegin);
  add_obstacle(message, {1, 1});
  add_obstacle(message, {2, 2});
  Frame frame;
  frame.assign(message, kBegin);
  CHECK(frame.obstacles_complete_within_m() == kCompleteEverywhere_m);
  SECTION("invalid position") { message.obstacles()[0].x_m(std::nan("")); }
  SECTION("invalid radius") { message.obstacles()[0].radius_m(0); }
  frame.assign(message, kBegin);
  CHECK(frame.is_usable());
  CHECK(frame.obstacles().size() == 1);
  CHECK(frame.obstacles_complete_within_m() == 0);
}

TEST_CASE("a frame with counts out of range is rejected as a whole") {
  msg::DetectionFrame message = frame_message(0, kBegin);
  std::uint64_t expected = 1;
  SECTION("too many balls") { message.ball_count(5); }
  SECTION("too many obstacles") { message.obstacle_count(msg::MAX_OBSTACLES + 1); }
  SECTION("too many robots") {
    message.robots().assign(kMaxRobots + 1, valid_robot());
    expected = kMaxRobots + 1;
  }
  Frame frame;
  frame.assign(message, kBegin);
  CHECK_FALSE(frame.is_usable());
  CHECK(frame.robots().empty());
  CHECK(frame.balls().empty());
  CHECK(frame.rejected() == expected);
}

TEST_CASE("a frame with an impossible completeness distance is rejected as a whole") {
  const double bad = GENERATE(std::numeric_limits<double>::quiet_NaN(), -1e-9, 1.001e9,
                              std::numeric_limits<double>::infinity());
  CAPTURE(bad);
  msg::DetectionFrame message = frame_message(0, kBegin);
  message.robots().push_back(valid_robot());
  add_obstacle(message, {1, 1});
  message.obstacles_complete_within_m(bad);
  Frame frame;
  frame.assign(message, kBegin);
  CHECK_FALSE(frame.is_usable());
  CHECK(frame.obstacles().empty());
  CHECK(frame.rejected() == 1);
  message.obstacles_complete_within_m(0.5);
  frame.assign(message, kBegin);
  CHECK(frame.obstacles().size() == 1);
  CHECK(frame.obstacles_complete_within_m() == 0.5);
}

TEST_CASE("a reused frame contains nothing from its previous message") {
  msg::DetectionFrame message = frame_message(7, kBegin);
  message.robots().assign(kMaxRobots, valid_robot());
  add_ball(message, {0, 0});
  Frame frame;
  frame.assign(message, kBegin);
  CHECK(frame.robots().size() == kMaxRobots);
  frame.assign(frame_message(8, kBegin), kBegin);
  CHECK(frame.camera() == 8);
  CHECK(frame.is_usable());
  CHECK(frame.robots().empty());
  CHECK(frame.balls().empty());
}

}  // namespace sidestep::frame_test
