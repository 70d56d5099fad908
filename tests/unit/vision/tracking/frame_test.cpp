// SPDX-License-Identifier: Apache-2.0
#include "vision/tracking/frame.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/unit/vision/floor.hpp"

using namespace sidestep;
using namespace sidestep::test;

namespace {

msg::RobotDetection good_robot() {
  msg::DetectionFrame frame;
  add_robot(frame, 3, {1, 2}, 0.5);
  return frame.robots()[0];
}

/// How many detections of a frame with this one and a good one are taken and rejected.
void check_that_only_the_good_one_is_taken(const msg::RobotDetection& bad) {
  msg::DetectionFrame message = frame_message(0, kBegin);
  message.robots().push_back(bad);
  message.robots().push_back(good_robot());
  Frame frame;
  frame.assign(message, kBegin);
  CHECK(frame.is_usable());
  REQUIRE(frame.robots().size() == 1);
  CHECK(frame.robots()[0].robot == 3);
  CHECK(frame.robots()[0].position_m == Vec2(1, 2));
  CHECK(frame.rejected() == 1);
}

}  // namespace

TEST_CASE("a detection with a number that makes no sense is dropped alone and counted") {
  const double bad =
      GENERATE(std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
               -std::numeric_limits<double>::infinity(), 100.001, -1e300);
  CAPTURE(bad);
  msg::RobotDetection d = good_robot();
  SECTION("x") { d.x_m(bad); }
  SECTION("y") { d.y_m(bad); }
  SECTION("heading") { d.heading_rad(bad); }
  SECTION("confidence") { d.confidence(bad); }
  check_that_only_the_good_one_is_taken(d);
}

TEST_CASE("a confidence outside 0..1 or a robot number beyond all robots is dropped alone and counted") {
  msg::RobotDetection d = good_robot();
  SECTION("confidence below 0") { d.confidence(-0.001); }
  SECTION("confidence above 1") { d.confidence(1.001); }
  SECTION("first number beyond") { d.robot(kMaxRobots); }
  SECTION("largest number") { d.robot(0xffffffff); }
  check_that_only_the_good_one_is_taken(d);
}

TEST_CASE("a ball that makes no sense is dropped alone and counted") {
  msg::DetectionFrame message = frame_message(0, kBegin);
  add_ball(message, {1, 1});
  add_ball(message, {std::nan(""), 1});
  add_ball(message, {1, 101});
  add_ball(message, {2, 2});
  message.balls()[3].confidence(2);
  Frame frame;
  frame.assign(message, kBegin);
  CHECK(frame.balls().size() == 1);
  CHECK(frame.rejected() == 3);
}

TEST_CASE("a frame from too long ago or from the future is refused as a whole") {
  const std::int64_t ns = to_ns(kBegin);
  const std::int64_t captured =
      GENERATE_COPY(ns - 500'000'001, ns + 100'000'001, std::int64_t{0},
                    std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max());
  CAPTURE(captured);
  msg::DetectionFrame message = frame_message(0, kBegin);
  message.captured_at_ns(captured);
  message.robots().push_back(good_robot());
  message.robots().push_back(good_robot());
  Frame frame;
  frame.assign(message, kBegin);
  CHECK_FALSE(frame.is_usable());
  CHECK(frame.robots().empty());
  CHECK(frame.rejected() == 2);
}

TEST_CASE("a frame just within the bounds of time is taken") {
  const Duration age = GENERATE(Duration{500'000'000}, Duration{-100'000'000});
  msg::DetectionFrame message = frame_message(0, kBegin - age);
  message.robots().push_back(good_robot());
  Frame frame;
  frame.assign(message, kBegin);
  CHECK(frame.is_usable());
  CHECK(frame.robots().size() == 1);
}

TEST_CASE("a frame with counts beyond its bounds is refused as a whole") {
  msg::DetectionFrame message = frame_message(0, kBegin);
  std::uint64_t expected = 1;
  SECTION("balls") { message.ball_count(5); }
  SECTION("robots") {
    message.robots().assign(kMaxRobots + 1, good_robot());
    expected = kMaxRobots + 1;
  }
  Frame frame;
  frame.assign(message, kBegin);
  CHECK_FALSE(frame.is_usable());
  CHECK(frame.robots().empty());
  CHECK(frame.balls().empty());
  CHECK(frame.rejected() == expected);
}

TEST_CASE("a frame that is used again holds nothing of the one before") {
  msg::DetectionFrame message = frame_message(7, kBegin);
  message.robots().assign(kMaxRobots, good_robot());
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
