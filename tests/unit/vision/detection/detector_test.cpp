// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "tests/unit/vision/detection/painted_floor.hpp"
#include "tests/unit/vision/detection/score.hpp"

using namespace sidestep;
using namespace sidestep::test;

namespace {

const Time kBegin = time_from_ns(1'700'000'000'000'000'000);
constexpr Duration kFrame{16'666'667};

FrameTask task_for(PaintedFloor& floor, const std::vector<Marked>& robots) {
  FrameTask task;
  task.boxes = floor.learned_boxes();
  task.layout = butterfly();
  task.roster = roster_of(robots);
  return task;
}

/// Frames of robots that take a new place every tenth one and move a little in between.
Score read_frames(PaintedFloor& floor, std::size_t each, int frames, int hidden) {
  std::vector<Marked> robots = floor.scattered_robots(each);
  Detector reader(floor.camera, task_for(floor, robots));
  Score score;
  msg::DetectionFrame frame;
  for (int i = 0; i < frames; ++i) {
    if (i % 10 == 0) robots = floor.scattered_robots(each);
    const auto expected = expected_of(robots);
    for (Marked& robot : robots) {
      robot.pose.position_m += 0.02 * Vec2(floor.rng.uniform(-1, 1), floor.rng.uniform(-1, 1));
      robot.pose.heading_rad += floor.rng.uniform(-0.1, 0.1);
    }
    const Image image = floor.frame(robots, floor.free_place(robots), hidden);
    reader.read(image.view(), kBegin + i * kFrame, expected, frame);
    score.add(robots, frame);
  }
  return score;
}

}  // namespace

TEST_CASE("robots in frames are found, named, and placed within a millimetre and a half") {
  const auto format = GENERATE(PixelFormat::kYuv422, PixelFormat::kRgb);
  const std::size_t each = GENERATE(6, 11);
  CAPTURE(format, each);
  RenderSpec spec;
  spec.format = format;
  PaintedFloor floor(each, spec);
  const Score score = read_frames(floor, each, 20, 0);
  CHECK(score.share() > 0.999);
  CHECK(score.wrong == 0);
  CHECK(score.position_m() < 0.0015);
  CHECK(score.heading_rad() < 0.6 / 57.3);
}

TEST_CASE("all sixteen patterns of both teams are told apart in frames") {
  PaintedFloor floor(3);
  const Score score = read_frames(floor, 16, 10, 0);
  CHECK(score.share() > 0.999);
  CHECK(score.wrong == 0);
}

TEST_CASE("robots with one dot covered are found and never confused") {
  PaintedFloor floor(4);
  const Score score = read_frames(floor, 11, 40, 1);
  CHECK(score.share() > 0.99);
  CHECK(score.wrong == 0);
}

TEST_CASE("a team is told from a centre whose colour lies beside that team's thresholds") {
  // As tint has it: all yellow centres are a little too orange for theirs. Nobody is expected anywhere, so
  // the centre alone says the team.
  const bool is_covered = GENERATE(false, true);
  CAPTURE(is_covered);
  PaintedFloor floor(5);
  std::vector<Marked> robots = floor.scattered_robots(16);
  FrameTask task = task_for(floor, robots);
  // No blue robot is there, though it might be.
  std::erase_if(robots, [](const Marked& robot) { return robot.entry.team == Team::kBlue; });
  for (ColourBox& box : task.boxes) {
    if (box.colour == static_cast<std::uint32_t>(Colour::kYellow)) box.low.v = 168;  // they have 152 to 158
  }
  Detector reader(floor.camera, task);
  msg::DetectionFrame frame;
  Score score;
  // The first of the dots that may be covered is the centre.
  reader.read(floor.frame(robots, {}, is_covered ? 1 : 0).view(), kBegin, {}, frame);
  score.add(robots, frame);
  CHECK(score.wrong == 0);
  if (!is_covered) CHECK(score.share() == 1);
}

TEST_CASE("robots are found where light falls to three fifths and its colour is off by a tenth") {
  const double drift = GENERATE(0.1, -0.1);
  CAPTURE(drift);
  RenderSpec spec;
  spec.far_light = 0.6;
  PaintedFloor learned(5, spec);
  const std::vector<ColourBox> boxes = learned.learned_boxes();
  spec.colour_gain = {1 + drift, 1, 1 - drift};
  PaintedFloor floor(6, spec);
  const std::vector<Marked> robots = floor.scattered_robots(11);
  FrameTask task;
  task.boxes = boxes;
  task.layout = butterfly();
  task.roster = roster_of(robots);
  Detector reader(floor.camera, task);
  Score score;
  msg::DetectionFrame frame;
  for (int i = 0; i < 20; ++i) {
    const std::vector<Marked> moved = floor.scattered_robots(11);
    reader.read(floor.frame(moved).view(), kBegin + i * kFrame, expected_of(moved), frame);
    score.add(moved, frame);
  }
  CHECK(score.share() > 0.995);
  CHECK(score.wrong == 0);
}

TEST_CASE("a ball is found, and dots are no balls") {
  PaintedFloor floor(7);
  const std::vector<Marked> robots = floor.scattered_robots(11);
  Detector reader(floor.camera, task_for(floor, robots));
  msg::DetectionFrame frame;
  int others = 0;
  for (int i = 0; i < 20; ++i) {
    const Vec2 ball = floor.free_place(robots);
    reader.read(floor.frame(robots, ball).view(), kBegin + i * kFrame, expected_of(robots), frame);
    REQUIRE(frame.ball_count() >= 1);
    others += frame.ball_count() - 1;
    CHECK((Vec2(frame.balls()[0].x_m(), frame.balls()[0].y_m()) - ball).norm() < 0.01);
  }
  CHECK(others == 0);
  reader.read(floor.frame(robots).view(), kBegin, expected_of(robots), frame);
  CHECK(frame.ball_count() == 0);
}

TEST_CASE("what has a colour that nobody wears is an obstacle, as large as it is") {
  PaintedFloor floor(8);
  const std::vector<Marked> robots = floor.scattered_robots(3);
  FrameTask task = task_for(floor, robots);
  const Rgb red = named(Colour::kRed).rgb;
  const std::vector<SceneBlob> blobs{{{{0.5, -0.7}, 0.2}, 0.002, red}};
  // Where it stands is known too: it is learned like the others.
  ColourLearner learner;
  const std::array discs{*seen_disc(floor.camera, Colour::kRed, {0.5, -0.7, 0}, 0.2)};
  learner.add(floor.frame({}, {}, 0, blobs).view(), discs);
  for (const ColourBox& box : learner.boxes()) task.boxes.push_back(box);
  Detector reader(floor.camera, task);
  msg::DetectionFrame frame;
  reader.read(floor.frame({}, {}, 0, blobs).view(), kBegin, {}, frame);
  REQUIRE(frame.obstacle_count() == 1);
  CHECK((Vec2(frame.obstacles()[0].x_m(), frame.obstacles()[0].y_m()) - Vec2(0.5, -0.7)).norm() < 0.02);
  CHECK(frame.obstacles()[0].radius_m() == Approx(0.2).margin(0.02));
  CHECK(frame.robots().empty());
}
