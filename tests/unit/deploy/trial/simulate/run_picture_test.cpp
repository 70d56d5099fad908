// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/run_picture.hpp"

#include "tests/catch.hpp"

namespace sidestep::run_picture_test {

/// The picture of a robot that drives 1 m along x in 1 s and a resting robot that is seen half as long.
std::string picture() {
  Scenario scenario;
  scenario.robots.resize(2);
  scenario.robots[1].id = 1;
  RunPicture result(scenario);
  for (int i = 0; i <= 10; ++i) {
    msg::GroundTruth truth;
    truth.valid_at_ns(5'000'000'000 + i * 100'000'000LL);
    truth.robots().resize(i <= 5 ? 2 : 1);
    for (std::size_t robot = 0; robot < truth.robots().size(); ++robot) {
      truth.robots()[robot].robot(static_cast<std::uint32_t>(robot));
      truth.robots()[robot].x_m(robot == 0 ? 0.1 * i : -1);
    }
    result.add(truth);
  }
  return result.svg();
}

TEST_CASE(
    "in the picture of a run each robot drives from its start to its end and rests there for a moment") {
  const std::string svg = picture();
  CAPTURE(svg);
  // The scale is 200 pixels per metre. Values are relative to the robot's end, where the robot is drawn.
  CHECK_THAT(svg, ContainsSubstring("values='-200,0;") && ContainsSubstring(";-100,0;"));
  CHECK_THAT(svg, ContainsSubstring(";-20,0;0,0;") || ContainsSubstring(";-20,0;-20,0;0,0;"));
  CHECK_THAT(svg, ContainsSubstring("values='0,0;0,0;"));
  std::size_t animations = 0;
  for (std::size_t at = svg.find("dur='2.50s'"); at != std::string::npos;
       at = svg.find("dur='2.50s'", at + 1))
    ++animations;
  CHECK(animations == 2);
}

}  // namespace sidestep::run_picture_test
