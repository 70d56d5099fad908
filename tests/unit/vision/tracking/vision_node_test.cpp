// SPDX-License-Identifier: Apache-2.0
#include "vision/tracking/vision_node.hpp"

#include <optional>

#include "common/messaging/sim/bus.hpp"
#include "common/protocol/senders.hpp"
#include "tests/catch.hpp"
#include "tests/drops.hpp"
#include "tests/unit/vision/tracker_fixture.hpp"

namespace sidestep::vision_node_test {

using namespace sidestep::test;

Scenario scenario_of(RobotId robots) {
  Scenario scenario;
  scenario.vision.position_noise_m = 0.0015;
  scenario.vision.delay = 35 * kMs;
  for (RobotId id = 0; id < robots; ++id) {
    RobotSpec robot;
    robot.id = id;
    scenario.robots.push_back(robot);
  }
  return scenario;
}

/// Two cameras over one robot. Each publishes detections that were captured 35 ms ago.
class Cameras {
 public:
  /// Each camera sees the robot off by this, in opposite directions.
  Cameras(Bus& bus, const TrueMotion& motion, Rng rng, const Vec2& error_m = Vec2(0, 0))
      : bus_(bus),
        motion_(motion),
        rng_(rng),
        error_m_(error_m),
        writer_(bus.advertise(topics::kDetections)) {
    bus_.at(kBegin + 40 * kMs, [this] { publish(); });
  }

 private:
  void publish() {
    const Time captured = bus_.now() - 35 * kMs;
    for (std::uint32_t camera = 0; camera < 2; ++camera) {
      msg::DetectionFrame frame = frame_message(camera, captured);
      Pose pose = motion_.at(captured);
      pose.position_m += (camera == 0 ? -1 : 1) * error_m_;
      if (!rng_.chance(0.02)) add_noisy_robot(frame, 0, pose, {}, rng_);
      writer_.publish(frame, bus_.now());
    }
    bus_.at(bus_.now() + kFrame, [this] { publish(); });
  }

  Bus& bus_;
  const TrueMotion& motion_;
  Rng rng_;
  Vec2 error_m_;
  Writer<msg::DetectionFrame> writer_;
};

std::vector<msg::WorldState> worlds_of_a_run(std::uint64_t seed, const NetworkSpec& network,
                                             const TrueMotion& motion) {
  SimNetwork net(seed, kBegin, network);
  SimBus camera_bus(net), vision_bus(net), listener_bus(net);
  std::vector<msg::WorldState> worlds;
  listener_bus.subscribe<msg::WorldState>(topics::kWorld,
                                          [&](const msg::WorldState& world) { worlds.push_back(world); });
  Cameras cameras(camera_bus, motion, Rng(seed + 1));
  VisionNode node(vision_bus, scenario_of(1), 77);
  net.run_until(after_s(5));
  return worlds;
}

TEST_CASE("the node publishes world states at the cameras' rate, valid at the time of publication") {
  Rng rng(301);
  const TrueMotion motion = TrueMotion::driving(rng, 6);
  const auto worlds = worlds_of_a_run(301, {}, motion);
  CHECK(worlds.size() == Approx(300).margin(3));
  std::uint64_t number = 0;
  for (const auto& world : worlds) {
    CHECK(world.vision() == 0);
    CHECK(world.header().sender() == static_cast<std::uint32_t>(Sender::kVision));
    CHECK(world.header().incarnation() == 77);
    CHECK(world.header().message_number() == ++number);
    CHECK(world.valid_at_ns() == world.header().stamp_ns());
    if (world.valid_at_ns() < to_ns(after_s(0.3))) continue;
    REQUIRE(world.robots().size() == 1);
    const auto& robot = world.robots()[0];
    CHECK((position_of(robot) - motion.at(time_from_ns(world.valid_at_ns())).position_m).norm() < 0.03);
    CHECK((observed_position_of(robot) - motion.at(time_from_ns(robot.observed_at_ns())).position_m).norm() <
          0.008);
    CHECK(world.valid_at_ns() - robot.observed_at_ns() < 150'000'000);
  }
}

TEST_CASE("world states remain usable when the network loses, delays, duplicates and reorders frames") {
  const std::uint64_t seed = GENERATE(311u, 312u, 313u);
  CAPTURE(seed);
  Rng rng(seed);
  const TrueMotion motion = TrueMotion::driving(rng, 6);
  NetworkSpec network;
  network.loss = 0.3;
  network.duplicate = 0.1;
  network.delay_min = Duration{0};
  network.delay_max = 150 * kMs;
  const auto worlds = worlds_of_a_run(seed, network, motion);
  int with_robot = 0;
  for (const auto& world : worlds) {
    if (world.valid_at_ns() < to_ns(after_s(0.5))) continue;
    REQUIRE(world.robots().size() == 1);
    const auto& robot = world.robots()[0];
    CHECK((observed_position_of(robot) - motion.at(time_from_ns(robot.observed_at_ns())).position_m).norm() <
          0.008);
    const double error =
        (position_of(robot) - motion.at(time_from_ns(world.valid_at_ns())).position_m).norm();
    CHECK(error < 6 * std::sqrt(robot.position_variance_m2()));
    ++with_robot;
  }
  CHECK(with_robot > 150);
}

TEST_CASE("cameras that disagree are corrected by half each, and named with the disagreement") {
  const double disagreement_m = GENERATE(0.01, 0.02, 0.04, 0.06);
  CAPTURE(disagreement_m);
  Rng rng(315);
  const TrueMotion motion = TrueMotion::driving(rng, 12);
  SimNetwork net(315, kBegin, {});
  SimBus camera_bus(net), vision_bus(net), listener_bus(net);
  double max_error_m = 0;
  listener_bus.subscribe<msg::WorldState>(topics::kWorld, [&](const msg::WorldState& world) {
    if (world.valid_at_ns() < to_ns(after_s(6)) || world.robots().empty()) return;
    const auto& robot = world.robots()[0];
    const Vec2 truth_m = motion.at(time_from_ns(robot.observed_at_ns())).position_m;
    max_error_m = std::max(max_error_m, (observed_position_of(robot) - truth_m).norm());
  });
  Cameras cameras(camera_bus, motion, Rng(316), Vec2(disagreement_m / 2, 0));
  VisionNode node(vision_bus, scenario_of(1), 77);
  std::string text;
  node.on_event(LogLevel::kInfo, [&](const LogEvent& event) {
    if (event.text.find("disagree") != std::string::npos) text = event.text;
  });
  net.run_until(after_s(11));
  CHECK(max_error_m < 0.01);
  REQUIRE_THAT(text, ContainsSubstring("cameras 0 and 1 disagree by "));
  const double printed_mm = std::stod(text.substr(std::string("cameras 0 and 1 disagree by ").size()));
  CHECK(printed_mm == Approx(disagreement_m * 1e3).epsilon(0.1));
}

TEST_CASE("the same seed gives the same world states") {
  Rng rng(321);
  const TrueMotion motion = TrueMotion::driving(rng, 6);
  NetworkSpec network;
  network.loss = 0.1;
  network.delay_max = 50 * kMs;
  CHECK(worlds_of_a_run(321, network, motion) == worlds_of_a_run(321, network, motion));
}

TEST_CASE("the node publishes world states even if no frame arrives") {
  SimNetwork net(331, kBegin, {});
  SimBus vision_bus(net), listener_bus(net);
  int count = 0;
  listener_bus.subscribe<msg::WorldState>(topics::kWorld, [&](const msg::WorldState& world) {
    CHECK(world.robots().empty());
    CHECK_FALSE(world.ball().is_visible());
    CHECK(world.frames() == 0);
    ++count;
  });
  VisionNode node(vision_bus, scenario_of(3), 1);
  net.run_until(after_s(1));
  CHECK(count >= 58);
}

TEST_CASE("the node publishes an obstacle list with every world state, complete once every camera watches") {
  SimNetwork net(335, kBegin, {});
  SimBus camera_bus(net), vision_bus(net), listener_bus(net);
  std::vector<std::int64_t> worlds_ns;
  std::vector<msg::ObstacleList> lists;
  listener_bus.subscribe<msg::WorldState>(
      topics::kWorld, [&](const msg::WorldState& world) { worlds_ns.push_back(world.valid_at_ns()); });
  listener_bus.subscribe<msg::ObstacleList>(topics::kObstacles,
                                            [&](const msg::ObstacleList& list) { lists.push_back(list); });
  VisionNode node(vision_bus, scenario_of(1), 78);
  net.run_until(after_s(0.5));
  auto writer = camera_bus.advertise(topics::kDetections);
  for (int k = 0; k < 30; ++k) {
    msg::DetectionFrame frame = frame_message(0, net.now());
    add_obstacle(frame, {1, 2});
    writer.publish(frame, camera_bus.now());
    frame = frame_message(1, net.now());
    if (k > 10) writer.publish(frame, camera_bus.now());
    net.run_until(net.now() + kFrame);
    if (k < 14) CHECK(lists.back().complete_within_m() == 0);
  }
  REQUIRE(lists.size() == worlds_ns.size());
  REQUIRE(lists.size() > 50);
  std::vector<std::int64_t> lists_ns;
  for (const msg::ObstacleList& list : lists) {
    CHECK(list.vision() == 0);
    CHECK(list.header().sender() == static_cast<std::uint32_t>(Sender::kVision));
    CHECK(list.header().incarnation() == 78);
    lists_ns.push_back(list.valid_at_ns());
  }
  std::sort(lists_ns.begin(), lists_ns.end());
  std::sort(worlds_ns.begin(), worlds_ns.end());
  CHECK(lists_ns == worlds_ns);
  CHECK(lists.front().obstacles().empty());
  CHECK(lists.back().complete_within_m() == kCompleteEverywhere_m);
  REQUIRE(lists.back().obstacles().size() == 1);
  CHECK(lists.back().obstacles()[0].y_m() == Approx(2));
}

// The caller provides the frames, as for the league's packets and for images.
TEST_CASE(
    "the list is complete only while every configured camera watches, and other cameras do not matter") {
  SimNetwork net(351, kBegin, {});
  SimBus vision_bus(net), listener_bus(net);
  const bool are_given = GENERATE(false, true);
  const std::vector<std::uint32_t> cameras = are_given ? std::vector{3U, 7U} : std::vector{0U, 1U};
  CAPTURE(are_given);
  std::optional<VisionNode> node;
  if (are_given)
    node.emplace(vision_bus, scenario_of(1), 1, FrameSource::kCaller, cameras);
  else
    node.emplace(vision_bus, scenario_of(1), 1, FrameSource::kCaller);
  bool is_complete = false, was_complete = false, was_always_complete = true;
  listener_bus.subscribe<msg::ObstacleList>(topics::kObstacles, [&](const msg::ObstacleList& list) {
    is_complete = list.complete_within_m() > 0;
    was_complete |= is_complete;
    was_always_complete &= list.complete_within_m() == kCompleteEverywhere_m && list.obstacles().empty();
  });
  const auto run = [&](double seconds, std::initializer_list<std::uint32_t> sending) {
    was_complete = false;
    for (double s = 0; s < seconds; s += to_seconds(kFrame)) {
      for (const std::uint32_t camera : sending) node->add_frame(frame_message(camera, net.now()));
      net.run_until(net.now() + kFrame);
    }
  };
  run(5, {cameras[0]});
  CHECK_FALSE(was_complete);  // the other camera was never heard
  run(1, {cameras[0], cameras[1]});
  CHECK(is_complete);
  run(0.7, {cameras[1]});
  run(10, {cameras[1]});
  CHECK_FALSE(was_complete);  // the other camera is dead
  run(1, {cameras[0], cameras[1]});
  CHECK(is_complete);
  // Any process may send packets with any camera number. Such packets are not used and do not stop robots.
  msg::DetectionFrame forged = frame_message(20, net.now());
  forged.obstacles_complete_within_m(0);
  add_obstacle(forged, {1, 1});
  for (int i = 0; i < 3; ++i) node->add_frame(forged);
  was_always_complete = true;
  for (int i = 0; i < 60; ++i) {
    for (const std::uint32_t camera : cameras) node->add_frame(frame_message(camera, net.now()));
    node->add_frame(frame_message(1000U + static_cast<std::uint32_t>(i), net.now()));
    net.run_until(net.now() + kFrame);
  }
  CHECK(was_always_complete);
  CHECK(drops_of(*node).total(DropReason::kMalformedFrame) == 63);
}

TEST_CASE(
    "a node that gets its frames from its caller ignores the bus and calls its listener with every world "
    "state") {
  SimNetwork net(341, kBegin, {});
  SimBus camera_bus(net), vision_bus(net);
  VisionNode node(vision_bus, scenario_of(2), 1, FrameSource::kCaller);
  msg::WorldState latest;
  int worlds = 0;
  node.set_listener([&](const msg::WorldState& world) {
    latest = world;
    ++worlds;
  });
  Rng rng(341);
  const TrueMotion motion = TrueMotion::driving(rng, 2);
  Cameras cameras(camera_bus, motion, Rng(342));
  for (int i = 0; i < 60; ++i) {
    net.run_until(kBegin + kFrame * (i + 1));
    msg::DetectionFrame frame = frame_message(0, net.now());
    add_robot(frame, 1, {1, 2});
    node.add_frame(frame);
  }
  CHECK(worlds >= 58);
  REQUIRE(latest.robots().size() == 1);
  CHECK(latest.robots()[0].robot() == 1);
  CHECK((position_of(latest.robots()[0]) - Vec2(1, 2)).norm() < 1e-3);
}

TEST_CASE("vision sees robots again after its clock and the cameras' clocks were ahead") {
  const Duration ahead = std::chrono::milliseconds(GENERATE(50, 5000, 3'500'000));
  CAPTURE(to_seconds(ahead));
  Rng rng(3);
  const TrueMotion motion = TrueMotion::driving(rng, 2);
  SimNetwork net(1, kBegin, {});
  SimBus camera_bus(net), vision_bus(net), listener_bus(net);
  std::optional<msg::WorldState> last;
  listener_bus.subscribe<msg::WorldState>(topics::kWorld,
                                          [&](const msg::WorldState& world) { last = world; });
  Cameras cameras(camera_bus, motion, Rng(2));
  VisionNode node(vision_bus, scenario_of(1), 77);
  net.run_until(after_s(1));
  for (SimBus* bus : {&camera_bus, &vision_bus}) bus->set_clock({ahead, 0, net.now()});
  net.run_until(after_s(2));
  for (SimBus* bus : {&camera_bus, &vision_bus}) bus->set_clock({});
  last.reset();
  net.run_until(after_s(2.3));
  REQUIRE(last);
  CHECK(time_from_ns(last->valid_at_ns()) > after_s(2.2));
  REQUIRE(last->robots().size() == 1);
  CHECK(time_from_ns(last->robots()[0].observed_at_ns()) > after_s(2.2));
}

}  // namespace sidestep::vision_node_test
