// SPDX-License-Identifier: Apache-2.0
#include "simulator/world/cameras.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "common/protocol/obstacle_bounds.hpp"
#include "tests/catch.hpp"

namespace sidestep::cameras_test {

const Time kBegin = time_from_ns(1'700'000'000'000'000'000);

Scenario scene() {
  Scenario scenario;
  scenario.field = {9, 6};
  for (const auto& [id, x] : {std::pair{3U, -3.0}, std::pair{8U, 3.0}, std::pair{9U, 0.1}}) {
    RobotSpec robot;
    robot.id = id;
    robot.start_m = Vec2(x, 1);
    scenario.robots.push_back(robot);
  }
  return scenario;
}

std::vector<Body> bodies_of(const Scenario& scenario) {
  std::vector<Body> bodies;
  for (const RobotSpec& robot : scenario.robots) bodies.emplace_back(robot.start_m, 3.1, BodySettings{});
  return bodies;
}

TEST_CASE("the cameras take turns, and each captures one frame per period") {
  Scenario scenario = scene();
  scenario.vision.columns = 2;
  scenario.vision.rows = 2;
  scenario.vision.rate_hz = 50;
  Cameras cameras(scenario, kBegin, 1);
  const auto bodies = bodies_of(scenario);
  msg::DetectionFrame frame;
  std::vector<std::vector<std::int64_t>> times(4);
  std::int64_t last = 0;
  for (int i = 0; i < 400; ++i) {
    const Time due = cameras.next_capture();
    cameras.capture(due, {bodies}, frame);
    REQUIRE(frame.captured_at_ns() == to_ns(due));
    REQUIRE(frame.captured_at_ns() > last);
    last = frame.captured_at_ns();
    times.at(frame.camera()).push_back(last);
  }
  for (const auto& of_camera : times) {
    REQUIRE(of_camera.size() == 100);
    for (std::size_t i = 1; i < of_camera.size(); ++i) CHECK(of_camera[i] - of_camera[i - 1] == 20'000'000);
  }
}

TEST_CASE("a camera sees its share of the field and the overlap") {
  const Scenario scenario = scene();
  Cameras cameras(scenario, kBegin, 1);
  const auto bodies = bodies_of(scenario);
  std::vector<std::set<RobotId>> seen(2);
  msg::DetectionFrame frame;
  for (int i = 0; i < 2; ++i) {
    cameras.capture(cameras.next_capture(), {bodies}, frame);
    for (const auto& robot : frame.robots()) seen.at(frame.camera()).insert(robot.robot());
  }
  CHECK(seen[0] == std::set<RobotId>{3, 9});
  CHECK(seen[1] == std::set<RobotId>{8, 9});
}

TEST_CASE("detection noise and dropouts match the values in the scenario") {
  const std::uint64_t seed = GENERATE(1, 2);
  CAPTURE(seed);
  Scenario scenario = scene();
  scenario.vision.position_noise_m = 0.0015;
  scenario.vision.heading_noise_rad = 0.05;
  scenario.vision.miss_probability = 0.1;
  Cameras cameras(scenario, kBegin, seed);
  const auto bodies = bodies_of(scenario);
  msg::DetectionFrame frame;
  const Vec2 ball(-1, -1);
  double sum = 0, square = 0, turn_square = 0;
  int count = 0, balls = 0;
  const int frames = 20'000;
  for (int i = 0; i < frames; ++i) {
    cameras.capture(cameras.next_capture(), {bodies, &ball}, frame);
    balls += frame.ball_count();
    for (const auto& robot : frame.robots()) {
      const std::size_t index = robot.robot() == 3 ? 0 : robot.robot() == 8 ? 1 : 2;
      const Vec2 error = Vec2(robot.x_m(), robot.y_m()) - bodies[index].position_m();
      sum += error.x() + error.y();
      square += error.squaredNorm();
      turn_square += std::pow(wrapped_rad(robot.heading_rad() - 3.1), 2);
      REQUIRE(std::abs(robot.heading_rad()) <= 3.1415926536);
      REQUIRE((robot.confidence() >= 0 && robot.confidence() <= 1));
      ++count;
    }
  }
  CHECK(std::abs(sum / (2 * count)) < 0.00005);
  CHECK(std::sqrt(square / (2 * count)) == Approx(0.0015).epsilon(0.03));
  CHECK(std::sqrt(turn_square / count) == Approx(0.05).epsilon(0.03));
  CHECK(count / (2.0 * frames) == Approx(0.9).epsilon(0.01));  // each camera sees two robots
  CHECK(balls / (0.5 * frames) == Approx(0.9).epsilon(0.02));
}

TEST_CASE("ghosts appear at the scenario's rate, within the camera's view") {
  Scenario scenario = scene();
  scenario.robots.clear();
  scenario.vision.ghost_probability = 0.2;
  Cameras cameras(scenario, kBegin, 5);
  msg::DetectionFrame frame;
  int ghosts = 0;
  for (int i = 0; i < 10'000; ++i) {
    cameras.capture(cameras.next_capture(), {}, frame);
    REQUIRE(frame.robots().size() <= 1);
    for (const auto& ghost : frame.robots()) {
      REQUIRE(ghost.robot() < kMaxRobots);
      REQUIRE(cameras.views()[frame.camera()].sees({ghost.x_m(), ghost.y_m()}));
      ++ghosts;
    }
  }
  CHECK(ghosts / 10'000.0 == Approx(0.2).epsilon(0.1));
}

TEST_CASE("ghost obstacles appear at the scenario's rate, within the camera's view") {
  Scenario scenario = scene();
  scenario.vision.ghost_obstacle_probability = 0.2;
  Cameras cameras(scenario, kBegin, 5);
  msg::DetectionFrame frame;
  int ghosts = 0;
  for (int i = 0; i < 10'000; ++i) {
    cameras.capture(cameras.next_capture(), {}, frame);
    REQUIRE(frame.obstacle_count() <= 1);
    if (frame.obstacle_count() == 0) continue;
    const auto& ghost = frame.obstacles()[0];
    REQUIRE(cameras.views()[frame.camera()].sees({ghost.x_m(), ghost.y_m()}));
    ++ghosts;
  }
  CHECK(ghosts / 10'000.0 == Approx(0.2).epsilon(0.1));
}

TEST_CASE("vision faults change the detections of the affected robots") {
  Scenario scenario = scene();
  scenario.vision.position_noise_m = 0;
  scenario.vision.overlap_m = 100;  // every camera sees everything
  const auto bodies = bodies_of(scenario);
  REQUIRE(bodies.size() >= 3);
  std::vector<VisionFault> errors(bodies.size());
  errors[0].offset_m = Vec2(0.02, -0.01);
  errors[1].shown_as = 2;
  errors[2].shown_as = 1;
  errors[2].frozen = VisionFault::Pose{Vec2(0.5, 0.25), 1};
  Cameras cameras(scenario, kBegin, 1);
  msg::DetectionFrame frame;
  cameras.capture(cameras.next_capture(), {bodies, nullptr, {}, errors}, frame);
  const auto place_of = [&](std::size_t index) {
    const auto seen = std::ranges::find_if(
        frame.robots(), [&](const auto& robot) { return robot.robot() == scenario.robots[index].id; });
    REQUIRE(seen != frame.robots().end());
    return Vec2(seen->x_m(), seen->y_m());
  };
  CHECK((place_of(0) - bodies[0].position_m() - Vec2(0.02, -0.01)).norm() < 1e-12);
  CHECK((place_of(2) - bodies[1].position_m()).norm() < 1e-12);
  CHECK((place_of(1) - Vec2(0.5, 0.25)).norm() < 1e-12);
}

TEST_CASE("cameras with an outward error disagree where two of them see") {
  const auto [columns, rows, disagreement] = GENERATE(
      table<int, int, double>({{1, 1, 0.0}, {2, 1, 2.0}, {2, 2, 4.5 / std::hypot(2.25, 1.5)}, {3, 1, 1.0}}));
  CAPTURE(columns, rows);
  constexpr double kError_m = 0.02;
  Scenario scenario = scene();
  scenario.vision.columns = columns;
  scenario.vision.rows = rows;
  scenario.vision.position_noise_m = 0;
  scenario.vision.overlap_m = 100;  // every camera sees everything
  Cameras cameras(scenario, kBegin, 1, kError_m);
  const auto bodies = bodies_of(scenario);
  const Vec2 ball(-1, -1);
  const std::vector<Circle> opponents{{{1, 1}, 0.2}};
  std::vector<Vec2> errors_m(static_cast<std::size_t>(columns * rows));
  msg::DetectionFrame frame;
  for (std::size_t i = 0; i < errors_m.size(); ++i) {
    cameras.capture(cameras.next_capture(), {bodies, &ball, opponents}, frame);
    const auto error = [&](const auto& seen, const Vec2& real_m) {
      return Vec2(Vec2(seen.x_m(), seen.y_m()) - real_m);
    };
    REQUIRE(frame.robots().size() == bodies.size());
    Vec2& error_m = errors_m.at(frame.camera());
    error_m = error(frame.robots()[0], bodies[0].position_m());
    for (std::size_t k = 1; k < bodies.size(); ++k)
      CHECK((error(frame.robots()[k], bodies[k].position_m()) - error_m).norm() < 1e-12);
    CHECK((error(frame.balls()[0], ball) - error_m).norm() < 1e-12);
    CHECK((error(frame.obstacles()[0], opponents[0].centre_m) - error_m).norm() < 1e-12);
    // The error points away from the centre, as the centre of the camera's view does.
    const CameraView& view = cameras.views()[frame.camera()];
    const Vec2 centre_m = (view.low_m + view.high_m) / 2;
    const bool is_central = centre_m.norm() < 1e-9;
    CHECK(error_m.norm() == Approx(is_central ? 0 : kError_m).margin(1e-12));
    CHECK(error_m.dot(centre_m) == Approx(error_m.norm() * centre_m.norm()).margin(1e-12));
  }
  if (errors_m.size() > 1) CHECK((errors_m[1] - errors_m[0]).norm() == Approx(disagreement * kError_m));
}

TEST_CASE("a delayed camera drops overdue frames") {
  const Scenario scenario = scene();
  Cameras cameras(scenario, kBegin, 1);
  msg::DetectionFrame frame;
  const auto bodies = bodies_of(scenario);
  const Time late = kBegin + std::chrono::seconds(10);
  int taken = 0;
  for (; cameras.next_capture() <= late; ++taken) cameras.capture(late, {bodies}, frame);
  CHECK(taken == 2);
}

TEST_CASE("opponents are detected as obstacles, with noise and dropouts") {
  const std::uint64_t seed = GENERATE(1, 2);
  CAPTURE(seed);
  Scenario scenario = scene();
  scenario.vision.columns = 1;
  scenario.vision.position_noise_m = 0.002;
  scenario.vision.miss_probability = 0.1;
  Cameras cameras(scenario, kBegin, seed);
  const std::vector<Circle> opponents{{{1, 1}, 0.2}, {{100, 0}, 0.2}, {{-1, 0.5}, 0.002}};
  msg::DetectionFrame frame;
  int count = 0;
  double square = 0;
  for (int i = 0; i < 5000; ++i) {
    cameras.capture(cameras.next_capture(), {{}, nullptr, opponents}, frame);
    REQUIRE(frame.obstacle_count() <= 2);
    for (std::size_t k = 0; k < frame.obstacle_count(); ++k) {
      const auto& seen = frame.obstacles()[k];
      const Circle& real = opponents[seen.x_m() > 0 ? 0 : 2];
      square += (Vec2(seen.x_m(), seen.y_m()) - real.centre_m).squaredNorm();
      REQUIRE(std::abs(seen.radius_m() - real.radius_m) < 0.012);
      REQUIRE(seen.radius_m() > 0);
      ++count;
    }
  }
  CHECK(count / 10'000.0 == Approx(0.9).epsilon(0.02));
  CHECK(std::sqrt(square / (2 * count)) == Approx(0.002).epsilon(0.05));
}

TEST_CASE("if there are more opponents than a frame holds, those nearest to a detected robot are listed") {
  Scenario scenario = scene();
  scenario.vision.columns = 1;
  scenario.vision.position_noise_m = 0;
  scenario.robots.resize(1);  // at (-3, 1)
  Cameras cameras(scenario, kBegin, 1);
  const auto bodies = bodies_of(scenario);
  std::vector<Circle> opponents;
  for (int i = 400; i > 0; --i) opponents.push_back({{-3 + 0.015 * i, 1}, 0.01});
  msg::DetectionFrame frame;
  cameras.capture(cameras.next_capture(), {bodies, nullptr, opponents}, frame);
  REQUIRE(frame.obstacle_count() == msg::MAX_OBSTACLES);
  for (const msg::ObstacleDetection& obstacle : frame.obstacles())
    CHECK(obstacle.x_m() < -3 + 0.015 * (msg::MAX_OBSTACLES + 0.5));
  CHECK(frame.obstacles_complete_within_m() == Approx(0.015 * msg::MAX_OBSTACLES - 0.01));
  opponents.resize(msg::MAX_OBSTACLES);
  cameras.capture(cameras.next_capture(), {bodies, nullptr, opponents}, frame);
  CHECK(frame.obstacle_count() == msg::MAX_OBSTACLES);
  CHECK(frame.obstacles_complete_within_m() == kCompleteEverywhere_m);
}

}  // namespace sidestep::cameras_test
