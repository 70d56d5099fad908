// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/laser_picture.hpp"

#include "deploy/trial/simulate/system/sim_system.hpp"
#include "tests/catch.hpp"

namespace sidestep::laser_picture_test {

using namespace std::chrono_literals;

/// A robot in front of a wall, and a person who walks past it.
Scenario scene() {
  Scenario scenario;
  scenario.field = {6, 4};
  RobotSpec robot;
  robot.id = 7;
  robot.start_m = {-2, 0};
  scenario.robots = {robot};
  scenario.obstacles = {Box{{1, -1}, {1.2, 1}}};
  scenario.opponents = {{0.25, 0.8, {{-1, -1.5}, {-1, 1.5}}}};
  scenario.laser.emplace();
  return scenario;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST_CASE("a picture of a laser's view shows the scan, where people may step out, and moving objects") {
  const Scenario scenario = scene();
  SimSystem system(scenario, 1);
  LaserPicture picture(scenario, 7);
  SimBus listener(system.network());
  listener.use_rules(SharedRules(scenario).fingerprint(), [](const auto&, const auto&) {});
  listener.subscribe<msg::LaserScan>(topics::kScan, 7,
                                     [&](const msg::LaserScan& scan) { picture.add(scan); });
  system.observer_bus().subscribe(topics::kTruth, [&](const msg::GroundTruth& truth) { picture.add(truth); });
  const std::string before = picture.svg();
  CHECK(count(before, "<polygon") == 1);  // the wall
  CHECK(count(before, "<line") == 0);
  system.run_for(2s);
  const std::string svg = picture.svg();
  CHECK(count(svg, "<polygon") == 2);
  // The legend, which both pictures have, shows each kind of stroke once.
  CHECK(count(svg, "stroke='#cf222e'") - count(before, "stroke='#cf222e'") > 2);
  CHECK(count(svg, "<circle") >= 2);  // the robot and the track
  // The track's outline and velocity.
  CHECK(count(svg, "stroke='#bf8700'") - count(before, "stroke='#bf8700'") == 2);
  CHECK(count(svg, ">7</text>") == 1);
  for (const char* text : {": what the laser of robot 7 shows</text>", ">hit</text>", ">0.5 m</text>"})
    CHECK(count(svg, text) == 1);
}

TEST_CASE("a robot without a laser has no picture of its view") {
  Scenario scenario = scene();
  CHECK_THROWS_WITH(LaserPicture(scenario, 8), "the scenario has no robot 8");
  scenario.laser.reset();
  CHECK_THROWS_WITH(LaserPicture(scenario, 7), "the scenario's robots have no laser");
}

}  // namespace sidestep::laser_picture_test
