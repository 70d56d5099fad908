// SPDX-License-Identifier: Apache-2.0
#include "vision/images/image_reader.hpp"

#include <fstream>
#include <limits>

#include "common/camera/camera_grid.hpp"
#include "common/config/scenario_loader.hpp"
#include "common/file/write_file.hpp"
#include "common/marking/butterfly.hpp"
#include "simulator/images/floor_scene.hpp"
#include "simulator/rendering/frame_renderer.hpp"
#include "tests/catch.hpp"
#include "vision/cameras/camera_file.hpp"
#include "vision/images/image_options.hpp"
#include "vision/tracking/tracker.hpp"

namespace sidestep::image_reader_test {

constexpr Time kNow = time_from_ns(5'010'000'000);

const std::string kFloor = R"(
field: {length_m: 6, width_m: 4.5}
vision: {columns: 2, overlap_m: 0.3, images: {}}
ball: {position_m: [0.6, 0.4]}
robots:
  - {id: 3, team: blue, start_m: [-1.5, 0.2], heading_rad: 1, goals_m: [[1, 0]]}
  - {id: 24, team: yellow, start_m: [1.2, -0.5], heading_rad: -2, goals_m: [[1, 1]]}
  - {id: 7, team: blue, start_m: [0.05, 1.5], goals_m: [[0, 1]]}
)";

msg::CameraImage image_of(const Scenario& scenario, std::uint32_t camera) {
  const CameraModel model = camera_grid(scenario)[camera];
  RenderSpec spec;
  spec.format = scenario.vision.images->format;
  FrameRenderer renderer(model, scenario.field, butterfly(), spec, Rng(3));
  const Image image = renderer.render(floor_scene(scenario).scene());
  msg::CameraImage message;
  message.camera(camera);
  message.captured_at_ns(5'000'000'000);
  message.image_format(spec.format == PixelFormat::kRgb ? msg::ImageFormat::IMAGE_RGB
                                                        : msg::ImageFormat::IMAGE_YUV422);
  message.width_px(static_cast<std::uint32_t>(image.view().width_px));
  message.height_px(static_cast<std::uint32_t>(image.view().height_px));
  message.pixels().assign(image.view().pixels, image.view().pixels + image.view().bytes());
  return message;
}

void write_cameras(const std::vector<NumberedCamera>& cameras, const std::string& path) {
  write_file(path, cameras_text(cameras));
}

std::vector<RobotId> robots_in(const msg::DetectionFrame& frame) {
  std::vector<RobotId> robots;
  for (const msg::RobotDetection& detection : frame.robots()) robots.push_back(detection.robot());
  std::ranges::sort(robots);
  return robots;
}

TEST_CASE("the robots in each camera's image are found at their positions") {
  Scenario scenario = parse_scenario(kFloor, "floor.yaml");
  scenario.vision.images->format = GENERATE(PixelFormat::kYuv422, PixelFormat::kRgb);
  ImageReader reader = image_reader(scenario, {});
  msg::DetectionFrame frame;
  REQUIRE(reader.read(image_of(scenario, 0), kNow, {}, frame));
  CHECK(frame.camera() == 0);
  CHECK(frame.captured_at_ns() == 5'000'000'000);
  CHECK(robots_in(frame) == std::vector<RobotId>{3, 7});
  REQUIRE(reader.read(image_of(scenario, 1), kNow, {}, frame));
  CHECK(robots_in(frame) == std::vector<RobotId>{7, 24});
  for (const msg::RobotDetection& detection : frame.robots()) {
    const RobotSpec& robot = *find_robot(scenario, detection.robot());
    CHECK(std::hypot(detection.x_m() - robot.start_m.x(), detection.y_m() - robot.start_m.y()) < 0.002);
    CHECK(std::abs(wrapped_rad(detection.heading_rad() - robot.start_heading_rad)) < 0.02);
  }
  REQUIRE(frame.ball_count() == 1);
  CHECK(std::hypot(frame.balls()[0].x_m() - 0.6, frame.balls()[0].y_m() - 0.4) < 0.003);
  CHECK(frame.obstacle_count() == 0);
}

TEST_CASE("unknown obstacles are reported, and the scenario's obstacles are not") {
  Scenario scenario = parse_scenario(kFloor, "floor.yaml");
  const Circle unknown{{-2.2, 1.2}, 0.15};
  scenario.obstacles = {Circle{{-1, -1}, 0.2}, unknown, Circle{{-0.6, 1.2}, 0.1}};
  const msg::CameraImage image = image_of(scenario, 0);
  msg::DetectionFrame frame;
  ImageReader all_known = image_reader(scenario, {});
  REQUIRE(all_known.read(image, kNow, {}, frame));
  CHECK(frame.obstacle_count() == 0);
  scenario.obstacles.erase(scenario.obstacles.begin() + 1);
  ImageReader one_unknown = image_reader(scenario, {});
  REQUIRE(one_unknown.read(image, kNow, {}, frame));
  REQUIRE(frame.obstacle_count() == 1);
  const msg::ObstacleDetection& detection = frame.obstacles()[0];
  CHECK(std::hypot(detection.x_m() - unknown.centre_m.x(), detection.y_m() - unknown.centre_m.y()) < 0.02);
  CHECK(std::abs(detection.radius_m() - unknown.radius_m) < 0.02);
}

TEST_CASE("an invalid image is rejected and changes nothing") {
  const Scenario scenario = parse_scenario(kFloor, "floor.yaml");
  ImageReader reader = image_reader(scenario, {});
  const msg::CameraImage good = image_of(scenario, 0);
  msg::DetectionFrame frame;
  REQUIRE(reader.read(good, kNow, {}, frame));
  const auto is_rejected = [&](const std::function<void(msg::CameraImage&)>& corrupt) {
    msg::CameraImage image = good;
    corrupt(image);
    msg::DetectionFrame unchanged;
    const bool is_read = reader.read(image, kNow, {}, unchanged);
    return !is_read && unchanged.robots().empty() && unchanged.captured_at_ns() == 0;
  };
  CHECK(is_rejected([](auto& image) { image.camera(2); }));
  CHECK(is_rejected([](auto& image) { image.camera(0xffffffff); }));
  for (const std::int64_t captured_at_ns :
       {std::numeric_limits<std::int64_t>::min(), std::int64_t{0}, std::int64_t{4'400'000'000},
        std::int64_t{5'200'000'000}, std::numeric_limits<std::int64_t>::max()}) {
    CAPTURE(captured_at_ns);
    CHECK(is_rejected([&](auto& image) { image.captured_at_ns(captured_at_ns); }));
  }
  CHECK(is_rejected([](auto& image) { image.width_px(0); }));
  CHECK(is_rejected([](auto& image) { image.width_px(0x80000000); }));
  CHECK(is_rejected([](auto& image) { image.height_px(581); }));
  CHECK(is_rejected([](auto& image) { image.image_format(msg::ImageFormat::IMAGE_RGB); }));
  CHECK(is_rejected([](auto& image) { image.image_format(static_cast<msg::ImageFormat>(7)); }));
  CHECK(is_rejected([](auto& image) { image.pixels().pop_back(); }));
  CHECK(is_rejected([](auto& image) { image.pixels().push_back(0); }));
  CHECK(is_rejected([](auto& image) { image.pixels().clear(); }));
  CHECK_FALSE(is_rejected([](auto&) {}));
}

TEST_CASE("the tracker's noise settings match the errors of detections in images") {
  // Wide and narrow fields, so that the image's longer side is parallel to the field's longer or shorter
  // side.
  const Field field = GENERATE(Field{6, 4.5}, Field{3, 4.5}, Field{9, 3});
  CAPTURE(field.length_m, field.width_m);
  Scenario scenario = parse_scenario(kFloor, "floor.yaml");
  scenario.vision.columns = 1;
  scenario.vision.overlap_m = 0;
  scenario.field = field;
  scenario.ball.reset();
  Rng rng(9);
  FrameRenderer renderer(camera_grid(scenario)[0], field, butterfly(), {}, Rng(3));
  ImageReader reader = image_reader(scenario, {});
  double square_m2 = 0, square_rad2 = 0;
  int detection_count = 0;
  for (int i = 0; i < 60; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      RobotSpec& robot = scenario.robots[k];
      const double share = (static_cast<double>(k) + rng.uniform(0.2, 0.8)) / 3 - 0.5;
      robot.start_m = {share * (field.length_m - 0.4), rng.uniform(-0.4, 0.4) * field.width_m};
      robot.start_heading_rad = rng.uniform(-3, 3);
    }
    const Image image = renderer.render(floor_scene(scenario).scene());
    msg::CameraImage message;
    message.captured_at_ns(5'000'000'000);
    message.width_px(780);
    message.height_px(580);
    message.pixels().assign(image.view().pixels, image.view().pixels + image.view().bytes());
    msg::DetectionFrame frame;
    REQUIRE(reader.read(message, kNow, {}, frame));
    for (const msg::RobotDetection& detection : frame.robots()) {
      const RobotSpec& truth = *find_robot(scenario, detection.robot());
      square_m2 += (Vec2(detection.x_m(), detection.y_m()) - truth.start_m).squaredNorm() / 2;
      square_rad2 += std::pow(wrapped_rad(detection.heading_rad() - truth.start_heading_rad), 2);
      ++detection_count;
    }
  }
  REQUIRE(detection_count > 150);
  const TrackModel robot = tracker_settings(scenario).robot;
  CHECK(robot.position_noise_m == Approx(std::sqrt(square_m2 / detection_count)).epsilon(0.35));
  CHECK(robot.heading_noise_rad == Approx(std::sqrt(square_rad2 / detection_count)).epsilon(0.35));
}

TEST_CASE("images of random pixels are processed") {
  const Scenario scenario = parse_scenario(kFloor, "floor.yaml");
  ImageReader reader = image_reader(scenario, {});
  msg::CameraImage image = image_of(scenario, 1);
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  Rng rng(seed);
  for (std::uint8_t& byte : image.pixels()) byte = static_cast<std::uint8_t>(rng.bits());
  msg::DetectionFrame frame;
  CHECK(reader.read(image, kNow, {}, frame));
  CHECK(frame.ball_count() <= msg::MAX_DETECTED_BALLS);
  CHECK(frame.obstacle_count() <= msg::MAX_OBSTACLES);
}

TEST_CASE("an outdated or inconsistent world state does not affect detection") {
  const Scenario scenario = parse_scenario(kFloor, "floor.yaml");
  ImageReader reader = image_reader(scenario, {});
  msg::WorldState world;
  world.robots().resize(2);
  world.robots()[0].robot(24);
  world.robots()[0].x_m(-1.5);
  world.robots()[0].y_m(0.2);
  world.robots()[1].robot(4000);
  world.valid_at_ns(GENERATE(as<std::int64_t>(), 0, 4'999'000'000));
  msg::DetectionFrame frame;
  REQUIRE(reader.read(image_of(scenario, 0), kNow, world, frame));
  CHECK(robots_in(frame) == std::vector<RobotId>{3, 7});
}

TEST_CASE("camera, colour or layout files that do not fit the scenario are refused with the file name") {
  const Scenario scenario = parse_scenario(kFloor, "floor.yaml");
  const std::string file = "image-reader-test.yaml";
  const auto refusal = [&](const ImageOptions& options) -> std::string {
    try {
      (void)image_reader(scenario, options);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "accepted";
  };
  const std::vector<CameraModel> cameras = camera_grid(scenario);
  write_cameras({{0, cameras[0].parameters()}, {1, cameras[1].parameters()}}, file);
  CHECK(refusal({.cameras_file = file}) == "accepted");
  write_cameras({{0, cameras[0].parameters()}}, file);
  CHECK(refusal({.cameras_file = file}) == file + ": expected 2 cameras for the scenario, got 1");
  write_cameras({{1, cameras[0].parameters()}, {0, cameras[1].parameters()}}, file);
  CHECK_THAT(refusal({.cameras_file = file}), ContainsSubstring("cameras[0].id: expected 0, got 1"));
  std::ofstream(file) << colours_text({PixelFormat::kRgb, {{{0, 0, 0}, {9, 9, 9}, 0}}});
  CHECK(refusal({.colours_file = file}) ==
        file + ": format: expected yuv422 for the scenario's images, got rgb");
  CHECK_THAT(refusal({.layout_file = file}), StartsWith(file + ":"));
  std::remove(file.c_str());
}

}  // namespace sidestep::image_reader_test
