// SPDX-License-Identifier: Apache-2.0
#include "vision/league/tracked_output.hpp"

#include "tests/catch.hpp"

namespace sidestep::tracked_output_test {

Scenario two_robots() {
  Scenario scenario;
  for (const auto& [id, team] : {std::pair{RobotId{3}, Team::kBlue}, {RobotId{19}, Team::kYellow}}) {
    RobotSpec robot;
    robot.id = id;
    robot.team = team;
    scenario.robots.push_back(robot);
  }
  return scenario;
}

msg::TrackedRobot tracked(RobotId id, double x_m, std::int64_t observed_at_ns) {
  msg::TrackedRobot robot;
  robot.robot(id);
  robot.x_m(x_m);
  robot.y_m(-1);
  robot.heading_rad(0.25);
  robot.vx_mps(1.5);
  robot.vy_mps(-0.5);
  robot.angular_radps(2);
  robot.observed_at_ns(observed_at_ns);
  return robot;
}

TEST_CASE("a world state is converted to a tracked packet with teams and numbers") {
  TrackedOutput output(two_robots(), 77);
  constexpr std::int64_t kNow = 1'700'000'000'000'000'000;
  msg::WorldState world;
  world.valid_at_ns(kNow);
  world.robots() = {tracked(3, 1, kNow - 20'000'000), tracked(19, 2, kNow - 200'000'000)};
  world.ball().is_visible(true);
  world.ball().x_m(0.5);
  world.ball().vx_mps(3);
  // Encodes and decodes the packet, as for a receiver.
  const auto packet = league::decode_tracked(encode(output.packet_of(world))).packet;
  REQUIRE(packet);
  CHECK(packet->source_name == "Sidestep");
  CHECK(packet->frame->frame_number == 1);
  CHECK(std::chrono::abs(packet->frame->at - Duration{kNow}) < std::chrono::microseconds(1));
  REQUIRE(packet->frame->robots.size() == 2);
  const league::TrackedRobot &blue = packet->frame->robots[0], &yellow = packet->frame->robots[1];
  CHECK(blue.team == Team::kBlue);
  CHECK(blue.number == 3);
  CHECK(blue.position_m == Vec2(1, -1));
  CHECK(blue.heading_rad == 0.25);
  CHECK(*blue.velocity_mps == Vec2(1.5, -0.5));
  CHECK(blue.angular_radps == 2.0);
  CHECK(blue.visibility == 1.0);
  CHECK(yellow.team == Team::kYellow);
  CHECK(yellow.number == 3);
  CHECK(yellow.visibility == 0.0);
  REQUIRE(packet->frame->balls.size() == 1);
  CHECK(packet->frame->balls[0].position_m == Vec3(0.5, 0, 0));
  CHECK(*packet->frame->balls[0].velocity_mps == Vec3(3, 0, 0));
  CHECK(output.packet_of(world).frame->frame_number == 2);
}

TEST_CASE("a sender has a different UUID in each incarnation") {
  msg::WorldState world;
  TrackedOutput first(two_robots(), 77), second(two_robots(), 78);
  const std::string name = first.packet_of(world).uuid;
  CHECK_THAT(name, Matches("[0-9a-f]{8}-[0-9a-f]{4}-4[0-9a-f]{3}-[89ab][0-9a-f]{3}-[0-9a-f]{12}"));
  CHECK(first.packet_of(world).uuid == name);
  CHECK(second.packet_of(world).uuid != name);
}

}  // namespace sidestep::tracked_output_test
