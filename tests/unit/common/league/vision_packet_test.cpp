// SPDX-License-Identifier: Apache-2.0
#include "common/league/vision_packet.hpp"

#include <limits>

#include "tests/catch.hpp"
#include "tests/unit/common/league/random_packets.hpp"

#include "league/vision.pb.h"

namespace sidestep::league::vision_packet_test {

std::vector<std::byte> bytes_of(const wire::vision::Packet& message) {
  const std::string text = message.SerializePartialAsString();
  const auto* begin = reinterpret_cast<const std::byte*>(text.data());
  return {begin, begin + text.size()};
}

wire::vision::Packet message_of(std::span<const std::byte> bytes) {
  wire::vision::Packet message;
  REQUIRE(message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size())));
  return message;
}

/// Checks equality within the single precision of millimetres on the wire.
void check_close(double a, double b) { CHECK(a == Approx(b).epsilon(1e-6).margin(1e-6)); }
void check_close(const Vec2& a, const Vec2& b) { CHECK((a - b).norm() <= 1e-6 * (1 + b.norm())); }
void check_close(const Vec3& a, const Vec3& b) { CHECK((a - b).norm() <= 1e-6 * (1 + b.norm())); }
void check_close(Duration a, Duration b) { CHECK(std::chrono::abs(a - b) < std::chrono::microseconds(1)); }
void check_close(std::uint32_t a, std::uint32_t b) { CHECK(a == b); }
template <typename T>
void check_close(const std::optional<T>& a, const std::optional<T>& b);
template <typename T>
void check_close(const std::vector<T>& a, const std::vector<T>& b);

void check_close(const DetectedBall& a, const DetectedBall& b) {
  check_close(a.position_m, b.position_m);
  check_close(a.height_m, b.height_m);
  check_close(a.confidence, b.confidence);
  check_close(a.pixel, b.pixel);
  check_close(a.area, b.area);
}

void check_close(const DetectedRobot& a, const DetectedRobot& b) {
  check_close(a.number, b.number);
  check_close(a.position_m, b.position_m);
  check_close(a.heading_rad, b.heading_rad);
  check_close(a.confidence, b.confidence);
  check_close(a.pixel, b.pixel);
  check_close(a.height_m, b.height_m);
}

void check_close(const LineMarking& a, const LineMarking& b) {
  CHECK(a.name == b.name);
  check_close(a.from_m, b.from_m);
  check_close(a.to_m, b.to_m);
  check_close(a.thickness_m, b.thickness_m);
  check_close(a.type, b.type);
}

void check_close(const ArcMarking& a, const ArcMarking& b) {
  CHECK(a.name == b.name);
  check_close(a.centre_m, b.centre_m);
  check_close(a.radius_m, b.radius_m);
  check_close(a.from_rad, b.from_rad);
  check_close(a.to_rad, b.to_rad);
  check_close(a.thickness_m, b.thickness_m);
  check_close(a.type, b.type);
}

void check_close(const CameraCalibration& a, const CameraCalibration& b) {
  CHECK(a.camera == b.camera);
  check_close(a.focal_length_px, b.focal_length_px);
  check_close(a.principal_point_px, b.principal_point_px);
  check_close(a.distortion, b.distortion);
  for (std::size_t i = 0; i < 4; ++i) check_close(a.rotation[i], b.rotation[i]);
  check_close(a.translation_m, b.translation_m);
  check_close(a.position_m, b.position_m);
  check_close(a.image_width_px, b.image_width_px);
  check_close(a.image_height_px, b.image_height_px);
}

void check_close(const DetectionFrame& a, const DetectionFrame& b) {
  CHECK(a.frame_number == b.frame_number);
  CHECK(a.camera == b.camera);
  check_close(a.captured, b.captured);
  check_close(a.sent, b.sent);
  check_close(a.captured_by_camera, b.captured_by_camera);
  check_close(a.balls, b.balls);
  check_close(a.yellow, b.yellow);
  check_close(a.blue, b.blue);
}

void check_close(const Geometry& a, const Geometry& b) {
  check_close(a.field.length_m, b.field.length_m);
  check_close(a.field.width_m, b.field.width_m);
  check_close(a.field.goal_width_m, b.field.goal_width_m);
  check_close(a.field.goal_depth_m, b.field.goal_depth_m);
  check_close(a.field.boundary_width_m, b.field.boundary_width_m);
  check_close(a.field.lines, b.field.lines);
  check_close(a.field.arcs, b.field.arcs);
  check_close(a.field.penalty_area_depth_m, b.field.penalty_area_depth_m);
  check_close(a.field.penalty_area_width_m, b.field.penalty_area_width_m);
  check_close(a.field.centre_circle_radius_m, b.field.centre_circle_radius_m);
  check_close(a.field.line_thickness_m, b.field.line_thickness_m);
  check_close(a.field.goal_centre_to_penalty_mark_m, b.field.goal_centre_to_penalty_mark_m);
  check_close(a.field.goal_height_m, b.field.goal_height_m);
  check_close(a.field.ball_radius_m, b.field.ball_radius_m);
  check_close(a.field.max_robot_radius_m, b.field.max_robot_radius_m);
  check_close(a.cameras, b.cameras);
}

template <typename T>
void check_close(const std::optional<T>& a, const std::optional<T>& b) {
  REQUIRE(a.has_value() == b.has_value());
  if (a) check_close(*a, *b);
}

template <typename T>
void check_close(const std::vector<T>& a, const std::vector<T>& b) {
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) check_close(a[i], b[i]);
}

/// A valid message.
wire::vision::Packet valid_message() {
  wire::vision::Packet message;
  auto& detection = *message.mutable_detection();
  detection.set_frame_number(7);
  detection.set_t_capture(12.5);
  detection.set_t_sent(12.51);
  detection.set_camera_id(2);
  auto& ball = *detection.add_balls();
  ball.set_confidence(1);
  ball.set_x(1000);
  ball.set_y(-2000);
  ball.set_pixel_x(3);
  ball.set_pixel_y(4);
  auto& robot = *detection.add_robots_blue();
  robot.set_confidence(0.5F);
  robot.set_robot_id(9);
  robot.set_x(-1500.5F);
  robot.set_y(250);
  robot.set_orientation(6.5F);
  robot.set_pixel_x(5);
  robot.set_pixel_y(6);
  robot.set_height(150);
  return message;
}

DecodeError error_of(const wire::vision::Packet& message) {
  const auto decoded = decode_vision(bytes_of(message));
  CHECK(decoded.packet.has_value() == (decoded.error == DecodeError::kNone));
  return decoded.error;
}

/// The error for the valid message after `change` has modified its detection.
template <typename Change>
DecodeError error_after(Change change) {
  wire::vision::Packet message = valid_message();
  change(*message.mutable_detection());
  return error_of(message);
}

const float kNan = std::numeric_limits<float>::quiet_NaN();
const float kInfinity = std::numeric_limits<float>::infinity();

TEST_CASE("a vision packet survives encoding and decoding") {
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const VisionPacket packet = test::random_vision_packet(rng);
    const auto decoded = decode_vision(encode(packet));
    REQUIRE(decoded.error == DecodeError::kNone);
    check_close(decoded.packet->detection, packet.detection);
    check_close(decoded.packet->geometry, packet.geometry);
    check_close(decoded.packet->source, packet.source);
  }
}

TEST_CASE("a packet describes robots and field of the largest floor of a scenario") {
  DetectedRobot robot;
  robot.number = 5;
  robot.position_m = {499.9, -499.9};
  DetectionFrame detection;
  detection.blue.push_back(robot);
  Geometry geometry;
  geometry.field.length_m = geometry.field.width_m = 1000;
  const auto decoded = decode_vision(encode(VisionPacket{detection, geometry, std::nullopt}));
  REQUIRE(decoded.error == DecodeError::kNone);
  check_close(decoded.packet->detection->blue[0].position_m, robot.position_m);
  CHECK(decoded.packet->geometry->field.length_m == 1000);
}

TEST_CASE("another program's detection is decoded into metres and radians") {
  const auto decoded = decode_vision(bytes_of(valid_message()));
  REQUIRE(decoded.packet);
  CHECK_FALSE(decoded.packet->geometry);
  const DetectionFrame& detection = *decoded.packet->detection;
  CHECK(detection.frame_number == 7);
  CHECK(detection.camera == 2);
  CHECK(detection.captured == std::chrono::milliseconds(12'500));
  CHECK(detection.sent == std::chrono::milliseconds(12'510));
  REQUIRE(detection.balls.size() == 1);
  check_close(detection.balls[0].position_m, Vec2(1, -2));
  CHECK_FALSE(detection.balls[0].height_m);
  CHECK(detection.yellow.empty());
  REQUIRE(detection.blue.size() == 1);
  CHECK(detection.blue[0].number == 9);
  check_close(detection.blue[0].position_m, Vec2(-1.5005, 0.25));
  check_close(*detection.blue[0].heading_rad, 6.5 - 2 * 3.14159265358979);
  check_close(*detection.blue[0].height_m, 0.15);
}

TEST_CASE("an encoded packet has every required field in the league's units") {
  DetectionFrame detection;
  detection.frame_number = 3;
  detection.camera = 1;
  detection.captured = std::chrono::milliseconds(2'500);
  detection.sent = std::chrono::milliseconds(2'510);
  DetectedRobot robot;
  robot.number = 5;
  robot.position_m = {1.25, -0.5};
  robot.heading_rad = 0.5;
  robot.confidence = 1;
  detection.yellow.push_back(robot);
  detection.balls.emplace_back();
  const auto message = message_of(encode(VisionPacket{detection, std::nullopt, std::nullopt}));
  REQUIRE(message.IsInitialized());
  CHECK(message.detection().t_capture() == 2.5);
  CHECK(message.detection().t_sent() == Approx(2.51));
  REQUIRE(message.detection().robots_yellow_size() == 1);
  const auto& sent = message.detection().robots_yellow(0);
  CHECK(sent.robot_id() == 5);
  CHECK(sent.x() == 1250);
  CHECK(sent.y() == -500);
  CHECK(sent.has_pixel_x());
  CHECK(sent.has_pixel_y());
  CHECK(message.detection().balls(0).has_pixel_x());
  CHECK(message.detection().robots_blue_size() == 0);
}

TEST_CASE("field numbers and types match the league's definition") {
  // From the league's tables: key = field number * 8 + type (0 varint, 1 double, 2 message,
  // 5 float).
  DetectedRobot robot;
  robot.number = 5;
  robot.position_m = {0.001, 0};
  robot.heading_rad = 0;
  robot.height_m = 0.001;
  DetectionFrame detection;
  detection.frame_number = 1;
  detection.camera = 2;
  detection.blue.push_back(robot);
  const std::vector<int> expected{
      1 * 8 + 2, 61,                                        // detection
      1 * 8 + 0, 1,                                         // frame number
      2 * 8 + 1, 0,  0, 0,    0,    0,         0, 0, 0,     // t_capture
      3 * 8 + 1, 0,  0, 0,    0,    0,         0, 0, 0,     // t_sent
      4 * 8 + 0, 2,                                         // camera
      7 * 8 + 2, 37,                                        // a blue robot
      1 * 8 + 5, 0,  0, 0,    0,                            // confidence
      2 * 8 + 0, 5,                                         // robot number
      3 * 8 + 5, 0,  0, 0x80, 0x3f,                         // x: 1
      4 * 8 + 5, 0,  0, 0,    0,    5 * 8 + 5, 0, 0, 0, 0,  // y, orientation
      6 * 8 + 5, 0,  0, 0,    0,    7 * 8 + 5, 0, 0, 0, 0,  // pixel
      8 * 8 + 5, 0,  0, 0x80, 0x3f,                         // height: 1
      3 * 8 + 0, 5,                                         // source
  };
  std::vector<int> bytes;
  for (const std::byte byte : encode(VisionPacket{detection, std::nullopt, 5})) {
    bytes.push_back(std::to_integer<int>(byte));
  }
  CHECK(bytes == expected);
}

TEST_CASE("a packet with an invalid number is rejected as a whole with the reason") {
  using D = wire::vision::DetectionFrame;
  CHECK(error_of(valid_message()) == DecodeError::kNone);
  for (const float wrong : {kNan, kInfinity, -kInfinity, 10'000'001.0F, -1e30F}) {
    CAPTURE(wrong);
    CHECK(error_after([=](D& d) { d.mutable_balls(0)->set_x(wrong); }) == DecodeError::kNumber);
    CHECK(error_after([=](D& d) { d.mutable_balls(0)->set_z(wrong); }) == DecodeError::kNumber);
    CHECK(error_after([=](D& d) { d.mutable_robots_blue(0)->set_y(wrong); }) == DecodeError::kNumber);
    CHECK(error_after([=](D& d) { d.mutable_robots_blue(0)->set_orientation(wrong); }) ==
          DecodeError::kNumber);
    CHECK(error_after([=](D& d) { d.mutable_robots_blue(0)->set_confidence(wrong); }) ==
          DecodeError::kNumber);
    CHECK(error_after([=](D& d) { d.mutable_robots_blue(0)->set_height(wrong); }) == DecodeError::kNumber);
  }
  for (const float wrong : {kNan, kInfinity, 1e7F}) {
    CHECK(error_after([=](D& d) { d.mutable_balls(0)->set_pixel_x(wrong); }) == DecodeError::kNumber);
    CHECK(error_after([=](D& d) { d.mutable_robots_blue(0)->set_pixel_y(wrong); }) == DecodeError::kNumber);
  }
  for (const double wrong : {static_cast<double>(kNan), static_cast<double>(kInfinity), -3600.001, 1e300}) {
    CAPTURE(wrong);
    CHECK(error_after([=](D& d) { d.set_t_capture(wrong); }) == DecodeError::kTime);
    CHECK(error_after([=](D& d) { d.set_t_sent(wrong); }) == DecodeError::kTime);
    CHECK(error_after([=](D& d) { d.set_t_capture_camera(wrong); }) == DecodeError::kTime);
  }
  CHECK(error_after([](D& d) { d.set_t_capture(-1), d.set_t_sent(-0.99); }) == DecodeError::kNone);
  CHECK(error_after([](D& d) { d.set_camera_id(kMaxCameras); }) == DecodeError::kCamera);
  CHECK(error_after([](D& d) { d.mutable_robots_blue(0)->set_robot_id(16); }) == DecodeError::kRobot);
  CHECK(error_after([](D& d) { d.mutable_robots_blue(0)->set_robot_id(~0U); }) == DecodeError::kRobot);
}

TEST_CASE("a packet with missing fields or too many elements is rejected") {
  using D = wire::vision::DetectionFrame;
  CHECK(error_after([](D& d) { d.clear_camera_id(); }) == DecodeError::kMalformed);
  CHECK(error_after([](D& d) { d.mutable_robots_blue(0)->clear_pixel_x(); }) == DecodeError::kMalformed);
  CHECK(decode_vision({}).error == DecodeError::kEmpty);
  CHECK(error_of(wire::vision::Packet{}) == DecodeError::kEmpty);
  CHECK(decode_vision(std::vector<std::byte>(kMaxDatagramSize + 1)).error == DecodeError::kTooLong);
  const auto many = [](int count) {
    return error_after([=](D& d) {
      for (int i = 1; i < count; ++i) *d.add_robots_blue() = d.robots_blue(0);
    });
  };
  CHECK(many(64) == DecodeError::kNone);
  CHECK(many(65) == DecodeError::kTooMany);
  CHECK(error_after([](D& d) {
          while (d.balls_size() < 129) *d.add_balls() = d.balls(0);
        }) == DecodeError::kTooMany);
}

TEST_CASE("an invalid geometry is rejected with the reason") {
  Rng rng(5);
  VisionPacket packet;
  packet.geometry = test::random_geometry(rng);
  packet.geometry->field.lines.resize(1);
  packet.geometry->cameras.resize(1);
  packet.geometry->cameras[0] = test::random_calibration(rng);
  const auto valid = message_of(encode(packet));
  const auto after = [&](auto change) {
    wire::vision::Packet message = valid;
    change(*message.mutable_geometry());
    return error_of(message);
  };
  using G = wire::vision::Geometry;
  CHECK(after([](G&) {}) == DecodeError::kNone);
  CHECK(after([](G& g) { g.mutable_field()->set_field_length(0); }) == DecodeError::kNumber);
  CHECK(after([](G& g) { g.mutable_field()->set_field_width(-6000); }) == DecodeError::kNumber);
  CHECK(after([](G& g) { g.mutable_field()->set_field_width(1 << 30); }) == DecodeError::kNumber);
  CHECK(after([](G& g) { g.mutable_field()->set_ball_radius(kNan); }) == DecodeError::kNumber);
  CHECK(after([](G& g) { g.mutable_field()->mutable_field_lines(0)->mutable_p2()->set_x(kNan); }) ==
        DecodeError::kNumber);
  CHECK(after([](G& g) { g.mutable_field()->mutable_field_lines(0)->set_name(std::string(257, 'x')); }) ==
        DecodeError::kText);
  CHECK(after([](G& g) { g.mutable_calib(0)->set_camera_id(64); }) == DecodeError::kCamera);
  CHECK(after([](G& g) { g.mutable_calib(0)->set_q3(kInfinity); }) == DecodeError::kNumber);
  CHECK(after([](G& g) { g.mutable_calib(0)->set_tz(1e9F); }) == DecodeError::kNumber);
  CHECK(after([](G& g) { g.mutable_calib(0)->set_pixel_image_width(~0U); }) == DecodeError::kNumber);
  CHECK(after([](G& g) {
          while (g.calib_size() < 65) *g.add_calib() = g.calib(0);
        }) == DecodeError::kTooMany);
  CHECK(after([](G& g) { g.clear_field(); }) == DecodeError::kMalformed);
}

}  // namespace sidestep::league::vision_packet_test
