// SPDX-License-Identifier: Apache-2.0
#include "vision/tracking/vision_event_logger.hpp"

#include "common/messaging/sim/bus.hpp"
#include "tests/catch.hpp"
#include "tests/log_events.hpp"
#include "tests/unit/vision/tracker_fixture.hpp"
#include "vision/tracking/vision_node.hpp"

namespace sidestep::vision_event_logger_test {

using namespace sidestep::test;

/// A vision node for robot 0 that receives frames.
struct Fixture {
  explicit Fixture(const std::vector<std::uint32_t>& cameras = {0}) {
    RobotSpec robot;
    robot.id = 0;
    scenario.robots.push_back(robot);
    node.emplace(bus, scenario, 77, FrameSource::kCaller, cameras);
    events.emplace(*node);
  }
  /// Runs for `duration` with a camera frame every 20 ms. Each frame shows the robot if `is_seen`.
  void run(Duration duration, std::uint32_t camera, bool is_seen, Duration clock_error = Duration{0}) {
    const Time end = network.now() + duration;
    while (network.now() < end) {
      msg::DetectionFrame frame = frame_message(camera, network.now() + clock_error);
      if (is_seen) add_robot(frame, 0, {1, 0});
      node->add_frame(frame);
      wait(20 * kMs);
    }
  }
  void wait(Duration duration) { network.run_until(network.now() + duration); }

  Scenario scenario;
  SimNetwork network{1, kBegin, {}};
  SimBus bus{network};
  std::optional<VisionNode> node;
  std::optional<LogEvents> events;
};

TEST_CASE("a camera that falls silent is reported as lost, and as back with its next frame") {
  Fixture f({4});
  f.run(1000 * kMs, 4, false);
  f.wait(2000 * kMs);
  f.run(1000 * kMs, 4, false);
  CAPTURE(f.events->text());
  CHECK(f.events->count("camera 4 has started to send frames") == 1);
  CHECK(f.events->count("camera 4 is lost") == 1);
  CHECK(f.events->count("camera 4 is back, after 2.0 s") == 1);
  CHECK(f.events->all().size() == 3);
}

TEST_CASE("a robot that no camera sees is reported as lost, and later as seen again") {
  Fixture f;
  f.run(1000 * kMs, 0, true);
  f.run(2000 * kMs, 0, false);
  CHECK(f.events->count("robot 0 is lost: no camera sees it") == 1);
  f.run(1000 * kMs, 0, true);
  CAPTURE(f.events->text());
  CHECK(f.events->count("robot 0 is seen again") == 1);
  CHECK(f.events->all().size() == 3);
  CHECK(f.events->all().back().robot == 0);
}

TEST_CASE(
    "refused frames are reported with the reason at growing intervals, as are cameras without usable "
    "frames") {
  Fixture f({2, 3});
  f.run(20'000 * kMs, 2, true, 3000 * kMs);
  CAPTURE(f.events->text());
  CHECK(f.events->count("captured -3.000 s before it arrived") == 4);  // at frames 1, 10, 100 and 1000
  CHECK(f.events->count("camera 2 has sent no usable frame so far") == 1);
  CHECK(f.events->count("camera 3 has sent no usable frame so far") == 1);
  CHECK(f.events->all().size() == 6);
  msg::DetectionFrame frame = frame_message(3, f.network.now());
  frame.obstacle_count(msg::MAX_OBSTACLES + 1);
  f.node->add_frame(frame);
  CHECK(f.events->count("camera 3: 1 frame(s) refused so far: malformed") == 1);
}

TEST_CASE("refused frames of unknown cameras are reported at intervals that grow tenfold") {
  Fixture f;
  for (std::uint32_t camera = 1; camera <= 10'000; ++camera)
    f.node->add_frame(frame_message(camera, f.network.now()));
  CAPTURE(f.events->text());
  CHECK(f.events->count("frame(s) of unconfigured cameras refused so far") == 5);
  CHECK(f.events->count("10000 frame(s) of unconfigured cameras refused so far") == 1);
  CHECK(f.events->all().size() == 5);
}

TEST_CASE("every pair of cameras that disagree is named once, although only eight are named at once") {
  constexpr std::uint32_t kCameras = 5;
  Fixture f({0, 1, 2, 3, 4});
  for (int i = 0; i < 2'000; ++i) {
    for (std::uint32_t camera = 0; camera < kCameras; ++camera) {
      msg::DetectionFrame frame = frame_message(camera, f.network.now());
      add_robot(frame, 0, {1 + 0.01 * camera, 0});
      f.node->add_frame(frame);
    }
    f.wait(20 * kMs);
  }
  CAPTURE(f.events->text());
  for (std::uint32_t first = 0; first < kCameras; ++first) {
    for (std::uint32_t second = first + 1; second < kCameras; ++second) {
      const std::string pair = "cameras " + std::to_string(first) + " and " + std::to_string(second);
      CHECK(f.events->count(pair + " disagree by ") == 1);
    }
  }
}

}  // namespace sidestep::vision_event_logger_test
