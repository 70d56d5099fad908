// SPDX-License-Identifier: Apache-2.0
#include "tests/catch.hpp"
#include "tests/unit/vision/detection/rendered_field.hpp"
#include "tests/unit/vision/detection/score.hpp"

namespace sidestep::detector_test {

using namespace sidestep::test;

const Time kBegin = time_from_ns(1'700'000'000'000'000'000);
constexpr Duration kFrame{16'666'667};

DetectorSettings settings_for(RenderedField& floor, const std::vector<PlacedRobot>& robots) {
  DetectorSettings settings;
  settings.boxes = floor.learned_boxes();
  settings.layout = butterfly();
  settings.roster = roster_of(robots);
  return settings;
}

/// Detects robots that jump to new poses every tenth frame and move slightly in between.
Score score_of_frames(RenderedField& floor, std::size_t robots_per_team, int frames, int hidden) {
  std::vector<PlacedRobot> robots = floor.scattered_robots(robots_per_team);
  Detector detector(floor.camera, settings_for(floor, robots));
  Score score;
  msg::DetectionFrame frame;
  for (int i = 0; i < frames; ++i) {
    if (i % 10 == 0) robots = floor.scattered_robots(robots_per_team);
    const auto expected = expected_of(robots);
    for (PlacedRobot& robot : robots) {
      const double y = floor.rng.uniform(-1, 1), x = floor.rng.uniform(-1, 1);
      robot.pose.position_m += 0.02 * Vec2(x, y);
      robot.pose.heading_rad += floor.rng.uniform(-0.1, 0.1);
    }
    const Image image = floor.frame(robots, floor.free_position(robots), hidden);
    detector.detect(image.view(), kBegin + i * kFrame, expected, frame);
    score.add(robots, frame);
  }
  return score;
}

TEST_CASE("robots in frames are found, identified, and located within 1.5 mm RMS") {
  const auto format = GENERATE(PixelFormat::kYuv422, PixelFormat::kRgb);
  const std::size_t robots_per_team = GENERATE(6, 11);
  CAPTURE(format, robots_per_team);
  RenderSpec spec;
  spec.format = format;
  RenderedField floor(robots_per_team, spec);
  const Score score = score_of_frames(floor, robots_per_team, 20, 0);
  CHECK(score.share() > 0.999);
  CHECK(score.wrong == 0);
  CHECK(score.position_m() < 0.0015);
  CHECK(score.heading_rad() < 0.6 / 57.3);
}

TEST_CASE("all sixteen patterns of both teams are distinguished in frames") {
  RenderedField floor(3);
  const Score score = score_of_frames(floor, 16, 10, 0);
  CHECK(score.share() > 0.999);
  CHECK(score.wrong == 0);
}

TEST_CASE("robots with one covered dot are found and never confused with each other") {
  RenderedField floor(4);
  const Score score = score_of_frames(floor, 11, 40, 1);
  CHECK(score.share() > 0.99);
  CHECK(score.wrong == 0);
}

TEST_CASE("a team is identified even if a centre's colour is just outside that team's thresholds") {
  // All yellow centres are slightly too orange for their thresholds, as in tinted light. No robot is
  // expected, so the centre alone determines the team.
  const bool is_covered = GENERATE(false, true);
  CAPTURE(is_covered);
  RenderedField floor(5);
  std::vector<PlacedRobot> robots = floor.scattered_robots(16);
  DetectorSettings settings = settings_for(floor, robots);
  // Blue robots are on the roster but not on the floor.
  std::erase_if(robots, [](const PlacedRobot& robot) { return robot.entry.team == Team::kBlue; });
  for (ColourBox& box : settings.boxes) {
    if (box.colour == static_cast<std::uint32_t>(Colour::kYellow))
      box.low.v = 168;  // yellow spans 152 to 158
  }
  Detector detector(floor.camera, settings);
  msg::DetectionFrame frame;
  Score score;
  // Covering one dot of each robot covers the centre dot of some.
  detector.detect(floor.frame(robots, {}, is_covered ? 1 : 0).view(), kBegin, {}, frame);
  score.add(robots, frame);
  CHECK(score.wrong == 0);
  if (!is_covered) CHECK(score.share() == 1);
}

TEST_CASE("robots are found where the light falls to 60 % and its colour is off by a tenth") {
  const double drift = GENERATE(0.1, -0.1);
  CAPTURE(drift);
  RenderSpec spec;
  spec.far_light = 0.6;
  RenderedField learned(5, spec);
  const std::vector<ColourBox> boxes = learned.learned_boxes();
  spec.colour_gain = {1 + drift, 1, 1 - drift};
  RenderedField floor(6, spec);
  const std::vector<PlacedRobot> robots = floor.scattered_robots(11);
  DetectorSettings settings;
  settings.boxes = boxes;
  settings.layout = butterfly();
  settings.roster = roster_of(robots);
  Detector detector(floor.camera, settings);
  Score score;
  msg::DetectionFrame frame;
  for (int i = 0; i < 20; ++i) {
    const std::vector<PlacedRobot> moved = floor.scattered_robots(11);
    detector.detect(floor.frame(moved).view(), kBegin + i * kFrame, expected_of(moved), frame);
    score.add(moved, frame);
  }
  CHECK(score.share() > 0.995);
  CHECK(score.wrong == 0);
}

TEST_CASE("a ball is found, and dots are not mistaken for balls") {
  RenderedField floor(7);
  const std::vector<PlacedRobot> robots = floor.scattered_robots(11);
  Detector detector(floor.camera, settings_for(floor, robots));
  msg::DetectionFrame frame;
  int false_positives = 0;
  for (int i = 0; i < 20; ++i) {
    const Vec2 ball = floor.free_position(robots);
    detector.detect(floor.frame(robots, ball).view(), kBegin + i * kFrame, expected_of(robots), frame);
    REQUIRE(frame.ball_count() >= 1);
    false_positives += frame.ball_count() - 1;
    CHECK((Vec2(frame.balls()[0].x_m(), frame.balls()[0].y_m()) - ball).norm() < 0.01);
  }
  CHECK(false_positives == 0);
  detector.detect(floor.frame(robots).view(), kBegin, expected_of(robots), frame);
  CHECK(frame.ball_count() == 0);
}

TEST_CASE("an object in a colour that no robot wears is an obstacle of the right size") {
  RenderedField floor(8);
  const std::vector<PlacedRobot> robots = floor.scattered_robots(3);
  DetectorSettings settings = settings_for(floor, robots);
  const Rgb red = named(Colour::kRed).rgb;
  const std::vector<SceneCylinder> cylinders{{{{0.5, -0.7}, 0.2}, 0.002, red}};
  // The obstacle's colour is learned from its known position.
  ColourLearner learner;
  const std::array discs{*projected_disc(floor.camera, Colour::kRed, {0.5, -0.7, 0}, 0.2)};
  learner.add(floor.frame({}, {}, 0, cylinders).view(), discs);
  for (const ColourBox& box : learner.boxes()) settings.boxes.push_back(box);
  Detector detector(floor.camera, settings);
  msg::DetectionFrame frame;
  detector.detect(floor.frame({}, {}, 0, cylinders).view(), kBegin, {}, frame);
  REQUIRE(frame.obstacle_count() == 1);
  CHECK((Vec2(frame.obstacles()[0].x_m(), frame.obstacles()[0].y_m()) - Vec2(0.5, -0.7)).norm() < 0.02);
  CHECK(frame.obstacles()[0].radius_m() == Approx(0.2).margin(0.02));
  CHECK(frame.robots().empty());
}

}  // namespace sidestep::detector_test
