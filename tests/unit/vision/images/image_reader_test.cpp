// SPDX-License-Identifier: Apache-2.0
#include "vision/images/image_reader.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <limits>

#include "vision/cameras/camera_file.hpp"
#include "common/camera/camera_grid.hpp"
#include "common/config/scenario_loader.hpp"
#include "common/marking/butterfly.hpp"
#include "simulator/images/floor_scene.hpp"
#include "simulator/rendering/frame_renderer.hpp"
#include "vision/images/image_options.hpp"
#include "vision/tracking/tracker.hpp"

namespace sidestep {
namespace {

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
  const CameraModel model = hang_grid(scenario)[camera];
  RenderSpec spec;
  spec.format = scenario.vision.images->format;
  FrameRenderer renderer(model, scenario.field, butterfly(), spec, Rng(3));
  const Image image = renderer.render(floor_scene(scenario).scene());
  msg::CameraImage message;
  message.camera(camera);
  message.captured_at_ns(5'000'000'000);
  message.image_format(spec.format == PixelFormat::kRgb ? msg::IMAGE_RGB : msg::IMAGE_YUV422);
  message.width_px(static_cast<std::uint32_t>(image.view().width_px));
  message.height_px(static_cast<std::uint32_t>(image.view().height_px));
  message.pixels().assign(image.view().pixels, image.view().pixels + image.view().bytes());
  return message;
}

std::vector<RobotId> seen_in(const msg::DetectionFrame& frame) {
  std::vector<RobotId> robots;
  for (const msg::RobotDetection& seen : frame.robots()) robots.push_back(seen.robot());
  std::ranges::sort(robots);
  return robots;
}

}  // namespace

TEST_CASE("each camera's image shows the robots before it where they are") {
  Scenario scenario = parse_scenario(kFloor, "floor.yaml");
  scenario.vision.images->format = GENERATE(PixelFormat::kYuv422, PixelFormat::kRgb);
  ImageReader reader = image_reader(scenario, {});
  msg::DetectionFrame frame;
  REQUIRE(reader.read(image_of(scenario, 0), kNow, {}, frame));
  CHECK(frame.camera() == 0);
  CHECK(frame.captured_at_ns() == 5'000'000'000);
  CHECK(seen_in(frame) == std::vector<RobotId>{3, 7});
  REQUIRE(reader.read(image_of(scenario, 1), kNow, {}, frame));
  CHECK(seen_in(frame) == std::vector<RobotId>{7, 24});
  for (const msg::RobotDetection& seen : frame.robots()) {
    const RobotSpec& robot = *find_robot(scenario, seen.robot());
    CHECK(std::hypot(seen.x_m() - robot.start_m.x(), seen.y_m() - robot.start_m.y()) < 0.002);
    CHECK(std::abs(wrapped_rad(seen.heading_rad() - robot.start_heading_rad)) < 0.02);
  }
  REQUIRE(frame.ball_count() == 1);
  CHECK(std::hypot(frame.balls()[0].x_m() - 0.6, frame.balls()[0].y_m() - 0.4) < 0.003);
  CHECK(frame.obstacle_count() == 0);
}

TEST_CASE("obstacles are told that the scenario does not know and those that it knows are not") {
  Scenario scenario = parse_scenario(kFloor, "floor.yaml");
  scenario.obstacles = {{{-1, -1}, 0.2}, {{-2.2, 1.2}, 0.15}, {{-0.6, 1.2}, 0.1}};
  const msg::CameraImage image = image_of(scenario, 0);
  msg::DetectionFrame frame;
  ImageReader knows = image_reader(scenario, {});
  REQUIRE(knows.read(image, kNow, {}, frame));
  CHECK(frame.obstacle_count() == 0);
  const Circle unknown = scenario.obstacles[1];
  scenario.obstacles.erase(scenario.obstacles.begin() + 1);
  ImageReader knows_less = image_reader(scenario, {});
  REQUIRE(knows_less.read(image, kNow, {}, frame));
  REQUIRE(frame.obstacle_count() == 1);
  const msg::ObstacleDetection& seen = frame.obstacles()[0];
  CHECK(std::hypot(seen.x_m() - unknown.centre_m.x(), seen.y_m() - unknown.centre_m.y()) < 0.02);
  CHECK(std::abs(seen.radius_m() - unknown.radius_m) < 0.02);
}

TEST_CASE("an image that no camera makes is refused and changes nothing") {
  const Scenario scenario = parse_scenario(kFloor, "floor.yaml");
  ImageReader reader = image_reader(scenario, {});
  const msg::CameraImage good = image_of(scenario, 0);
  msg::DetectionFrame frame;
  REQUIRE(reader.read(good, kNow, {}, frame));
  const auto is_refused = [&](const std::function<void(msg::CameraImage&)>& spoil) {
    msg::CameraImage image = good;
    spoil(image);
    msg::DetectionFrame untouched;
    const bool is_read = reader.read(image, kNow, {}, untouched);
    return !is_read && untouched.robots().empty() && untouched.captured_at_ns() == 0;
  };
  CHECK(is_refused([](auto& image) { image.camera(2); }));
  CHECK(is_refused([](auto& image) { image.camera(0xffffffff); }));
  for (const std::int64_t captured_at_ns :
       {std::numeric_limits<std::int64_t>::min(), std::int64_t{0}, std::int64_t{4'400'000'000},
        std::int64_t{5'200'000'000}, std::numeric_limits<std::int64_t>::max()}) {
    CAPTURE(captured_at_ns);
    CHECK(is_refused([&](auto& image) { image.captured_at_ns(captured_at_ns); }));
  }
  CHECK(is_refused([](auto& image) { image.width_px(0); }));
  CHECK(is_refused([](auto& image) { image.width_px(0x80000000); }));
  CHECK(is_refused([](auto& image) { image.height_px(581); }));
  CHECK(is_refused([](auto& image) { image.image_format(msg::IMAGE_RGB); }));
  CHECK(is_refused([](auto& image) { image.image_format(static_cast<msg::ImageFormat>(7)); }));
  CHECK(is_refused([](auto& image) { image.pixels().pop_back(); }));
  CHECK(is_refused([](auto& image) { image.pixels().push_back(0); }));
  CHECK(is_refused([](auto& image) { image.pixels().clear(); }));
  CHECK_FALSE(is_refused([](auto&) {}));
}

TEST_CASE("the tracker expects the errors that images really have") {
  // Wide and narrow fields, so that the image's longer side lies along either of the field's.
  const Field field = GENERATE(Field{6, 4.5}, Field{3, 4.5}, Field{9, 3});
  CAPTURE(field.length_m, field.width_m);
  Scenario scenario = parse_scenario(kFloor, "floor.yaml");
  scenario.vision.columns = 1;
  scenario.vision.overlap_m = 0;
  scenario.field = field;
  scenario.ball.reset();
  Rng rng(9);
  FrameRenderer renderer(hang_grid(scenario)[0], field, butterfly(), {}, Rng(3));
  ImageReader reader = image_reader(scenario, {});
  double square_m2 = 0, square_rad2 = 0;
  int seen_count = 0;
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
    for (const msg::RobotDetection& seen : frame.robots()) {
      const RobotSpec& truth = *find_robot(scenario, seen.robot());
      square_m2 += (Vec2(seen.x_m(), seen.y_m()) - truth.start_m).squaredNorm() / 2;
      square_rad2 += std::pow(wrapped_rad(seen.heading_rad() - truth.start_heading_rad), 2);
      ++seen_count;
    }
  }
  REQUIRE(seen_count > 150);
  const TrackModel robot = tracker_settings(scenario).robot;
  CHECK(robot.position_noise_m == Approx(std::sqrt(square_m2 / seen_count)).epsilon(0.35));
  CHECK(robot.heading_noise_rad == Approx(std::sqrt(square_rad2 / seen_count)).epsilon(0.35));
}

TEST_CASE("any pixels are read") {
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

TEST_CASE("a world from long ago or from nonsense does no harm") {
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
  CHECK(seen_in(frame) == std::vector<RobotId>{3, 7});
}

TEST_CASE("cameras and colours that do not fit the scenario are refused by their file") {
  const Scenario scenario = parse_scenario(kFloor, "floor.yaml");
  const std::string file = "image-reader-test.yaml";
  const auto refusal = [&](const ImageOptions& options) -> std::string {
    try {
      image_reader(scenario, options);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "accepted";
  };
  const std::vector<CameraModel> cameras = hang_grid(scenario);
  save_cameras({{0, cameras[0].parameters()}, {1, cameras[1].parameters()}}, file);
  CHECK(refusal({.cameras_file = file}) == "accepted");
  save_cameras({{0, cameras[0].parameters()}}, file);
  CHECK(refusal({.cameras_file = file}) == file + ": 1 cameras, 2 expected");
  save_cameras({{1, cameras[0].parameters()}, {0, cameras[1].parameters()}}, file);
  CHECK_THAT(refusal({.cameras_file = file}), Catch::Contains("camera 1 stands where 0 is expected"));
  std::ofstream(file) << colours_text({PixelFormat::kRgb, {{{0, 0, 0}, {9, 9, 9}, 0}}});
  CHECK(refusal({.colours_file = file}) == file + ": is for rgb, and the scenario's images are yuv422");
  CHECK_THAT(refusal({.layout_file = file}), Catch::StartsWith(file + ":"));
  std::remove(file.c_str());
}

}  // namespace sidestep
