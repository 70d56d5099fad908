// SPDX-License-Identifier: Apache-2.0
#include "simulator/league/league_frames.hpp"

#include <Eigen/Geometry>
#include <stdexcept>

#include "common/random/rng.hpp"
#include "simulator/league/league_geometry.hpp"
#include "simulator/rendering/field_surface.hpp"
#include "tests/catch.hpp"

namespace sidestep::league_frames_test {

constexpr Time kNow = time_from_ns(1'700'000'000'000'000'000);

Scenario two_teams() {
  Scenario scenario;
  for (const auto& [id, team] : {std::pair{RobotId{3}, Team::kBlue}, {RobotId{19}, Team::kYellow}}) {
    RobotSpec robot;
    robot.id = id;
    robot.team = team;
    scenario.robots.push_back(robot);
  }
  return scenario;
}

msg::RobotDetection robot(RobotId id, double x_m, double y_m, double heading_rad) {
  msg::RobotDetection seen;
  seen.robot(id);
  seen.x_m(x_m);
  seen.y_m(y_m);
  seen.heading_rad(heading_rad);
  seen.confidence(0.75);
  return seen;
}

/// Projection by the league's formula, independent of CameraModel.
Vec2 projected(const league::CameraCalibration& camera, const Vec3& point_m) {
  const auto& q = camera.rotation;
  const Eigen::Quaterniond rotation(q[3], q[0], q[1], q[2]);
  const Vec3 seen = rotation * point_m + camera.translation_m;
  return camera.principal_point_px + camera.focal_length_px * Vec2(seen.x() / seen.z(), seen.y() / seen.z());
}

TEST_CASE("frames are converted to packets with both teams and all data that receivers need") {
  const Scenario scenario = two_teams();
  const Cameras cameras(scenario, kNow, 1);
  LeagueFrames frames(scenario, cameras.views());
  msg::DetectionFrame frame;
  frame.camera(1);
  frame.captured_at_ns(to_ns(kNow) - 10'000'000);
  frame.robots() = {robot(3, 1, 0.5, 0.25), robot(19, 2, -0.5, -3)};
  frame.ball_count(1);
  frame.balls()[0].x_m(1.5);
  frame.balls()[0].confidence(1);
  frame.obstacle_count(1);
  frame.obstacles()[0].x_m(3);
  frame.obstacles()[0].y_m(1);
  const auto decoded = league::decode_vision(encode(frames.detection(frame, kNow)));
  REQUIRE(decoded.packet);
  const league::DetectionFrame& detection = *decoded.packet->detection;
  CHECK(detection.camera == 1);
  CHECK(detection.frame_number == 1);
  CHECK(std::chrono::abs(detection.sent - detection.captured - Duration{10'000'000}) < Duration{1000});
  REQUIRE(detection.blue.size() == 1);
  CHECK(detection.blue[0].number == 3);
  CHECK((detection.blue[0].position_m - Vec2(1, 0.5)).norm() < 1e-6);
  CHECK(*detection.blue[0].heading_rad == Approx(0.25));
  CHECK(detection.blue[0].confidence == 0.75);
  REQUIRE(detection.yellow.size() == 2);
  CHECK(detection.yellow[0].number == 3);
  CHECK_FALSE(detection.yellow[1].number);
  CHECK_FALSE(detection.yellow[1].heading_rad);
  CHECK((detection.yellow[1].position_m - Vec2(3, 1)).norm() < 1e-6);
  REQUIRE(detection.balls.size() == 1);
  CHECK(detection.balls[0].position_m.x() == Approx(1.5));
  CHECK(frames.detection(frame, kNow).detection->frame_number == 2);
}

TEST_CASE("pixel positions agree with the cameras of the geometry") {
  const Scenario scenario = two_teams();
  const Cameras cameras(scenario, kNow, 1);
  LeagueFrames frames(scenario, cameras.views());
  const auto geometry = frames.geometry().geometry;
  REQUIRE(geometry);
  REQUIRE(geometry->cameras.size() == 2);
  Rng rng(4);
  for (int i = 0; i < 200; ++i) {
    const auto number = static_cast<std::uint32_t>(rng.below(2));
    const CameraView& view = cameras.views()[number];
    const double x_m = rng.uniform(view.low_m.x(), view.high_m.x());
    const double y_m = rng.uniform(view.low_m.y(), view.high_m.y());
    msg::DetectionFrame frame;
    frame.camera(number);
    frame.robots() = {robot(3, x_m, y_m, 0)};
    const auto packet = frames.detection(frame, kNow);
    const league::DetectedRobot& seen = packet.detection->blue.at(0);
    const league::CameraCalibration& camera = geometry->cameras[number];
    CHECK((seen.pixel - projected(camera, {x_m, y_m, *seen.height_m})).norm() < 1e-6);
    for (const double height_m : {0.0, 0.15}) {
      const Vec2 pixel = projected(camera, {x_m, y_m, height_m});
      CHECK(pixel.x() >= -0.5 - 1e-9);
      CHECK(pixel.x() <= 779.5 + 1e-9);
      CHECK(pixel.y() >= -0.5 - 1e-9);
      CHECK(pixel.y() <= 579.5 + 1e-9);
    }
    const auto& q = camera.rotation;
    const Eigen::Quaterniond rotation(q[3], q[0], q[1], q[2]);
    CHECK((rotation * *camera.position_m + camera.translation_m).norm() < 1e-9);
  }
}

TEST_CASE("the geometry contains the scenario's field with its markings") {
  for (const auto& [field, goal_width_m] :
       {std::pair{Field{12, 9}, 1.8}, {Field{9, 6}, 1.0}, {Field{1.2, 0.9}, 0.15}, {Field{6, 0.9}, 0.15}}) {
    CAPTURE(field.length_m);
    Scenario scenario = two_teams();
    scenario.field = field;
    const Cameras cameras(scenario, kNow, 1);
    const auto decoded = league::decode_vision(encode(LeagueFrames(scenario, cameras.views()).geometry()));
    REQUIRE(decoded.packet);
    const league::FieldSize& size = decoded.packet->geometry->field;
    CHECK(size.length_m == Approx(field.length_m));
    CHECK(size.width_m == Approx(field.width_m));
    CHECK(size.goal_width_m == Approx(goal_width_m));
    CHECK(size.lines.size() == 12);
    REQUIRE(size.arcs.size() == 1);
    CHECK(field.contains({0, 0}, size.arcs[0].radius_m));
    for (const league::LineMarking& line : size.lines) {
      CAPTURE(line.name);
      CHECK(field.contains(line.from_m, -1e-6));
      CHECK(field.contains(line.to_m, -1e-6));
      CHECK((line.from_m - line.to_m).norm() > 0.1);
    }
  }
}

TEST_CASE("rendered field lines coincide with the lines of the geometry") {
  for (const Field& field : {Field{12, 9}, Field{9, 6}, Field{4.5, 3.5}, Field{14, 4}}) {
    CAPTURE(field.length_m, field.width_m);
    const league::FieldSize size = league_field(field);
    const FieldLines lines(field);
    const double on_line_m = -size.line_thickness_m.value() / 2;
    for (const league::LineMarking& line : size.lines) {
      CAPTURE(line.name);
      for (const double share : {0.0, 0.3, 1.0})
        CHECK(lines.distance_m(line.from_m + share * (line.to_m - line.from_m)) == Approx(on_line_m));
    }
    REQUIRE(size.arcs.size() == 1);
    CHECK(lines.distance_m(rotated({size.arcs[0].radius_m, 0}, 0.7)) == Approx(on_line_m));
  }
}

TEST_CASE("scenarios that packets cannot represent are refused") {
  Scenario scenario = two_teams();
  scenario.vision.columns = 9;
  scenario.vision.rows = 8;
  const Cameras many(scenario, kNow, 1);
  CHECK_THROWS_WITH(LeagueFrames(scenario, many.views()),
                    ContainsSubstring("72 cameras, expected at most 64"));
  scenario = two_teams();
  scenario.robots[1].team = Team::kBlue;
  const Cameras cameras(scenario, kNow, 1);
  CHECK_THROWS_AS(LeagueFrames(scenario, cameras.views()), std::invalid_argument);
}

}  // namespace sidestep::league_frames_test
