// SPDX-License-Identifier: Apache-2.0
#include "simulator/images/image_output.hpp"

#include <map>

#include "common/camera/camera_grid.hpp"
#include "common/config/scenario_loader.hpp"
#include "common/marking/butterfly.hpp"
#include "common/messaging/sim/bus.hpp"
#include "tests/catch.hpp"

namespace sidestep::image_output_test {

const std::string kFloor = R"(
field: {length_m: 4, width_m: 3}
vision: {columns: 2, delay_ms: 25, images: {width_px: 200, height_px: 150}}
ball: {position_m: [0.6, 0.4]}
robots:
  - {id: 3, team: blue, start_m: [-1, 0.2], heading_rad: 1, goals_m: [[1, 0]]}
  - {id: 20, team: yellow, start_m: [1, -0.5], goals_m: [[1, 1]]}
  - {id: 5, start_m: [0, 0], goals_m: [[0, 1]], absent: true}
obstacles: [{centre_m: [-0.6, -0.7], radius_m: 0.2}]
opponents: [{radius_m: 0.12, speed_mps: 1, path_m: [[0, 1.2], [1, 1.2]]}]
)";

struct ImageSystem {
  explicit ImageSystem(const Scenario& with) : scenario(with), network(1, kBegin, scenario.network) {
    listener.subscribe<msg::CameraImage>(topics::kImages, [this](const msg::CameraImage& image) {
      images[image.camera()].push_back(image);
      late.push_back(network.now() - time_from_ns(image.captured_at_ns()));
    });
    listener.subscribe<msg::DetectionFrame>(topics::kDetections,
                                            [this](const msg::DetectionFrame&) { ++detections; });
  }
  static constexpr Time kBegin = time_from_ns(1'000'000'000'000);
  Scenario scenario;
  SimNetwork network;
  SimBus bus{network};
  SimulatorNode simulator{bus, scenario, 7, 1};
  ImageOutput output{bus, scenario, simulator, 7, 1};
  SimBus listener{network};
  std::map<std::uint32_t, std::vector<msg::CameraImage>> images;
  std::vector<Duration> late;
  int detections = 0;
};

std::vector<std::uint8_t> rendered(const Scenario& scenario, const CameraModel& camera) {
  RenderSpec spec;
  spec.noise = 0;
  FrameRenderer renderer(camera, scenario.field, butterfly(), spec, Rng(5));
  const Image image = renderer.render(floor_scene(scenario).scene());
  return {image.view().pixels, image.view().pixels + image.view().bytes()};
}

TEST_CASE("a scenario's floor contains all its objects except absent robots") {
  const Scenario scenario = parse_scenario(kFloor, "floor.yaml");
  const FloorScene floor = floor_scene(scenario);
  REQUIRE(floor.robots.size() == 2);
  CHECK(floor.robots[0].team == Team::kBlue);
  CHECK(floor.robots[0].pattern == 3);
  CHECK(floor.robots[0].position_m == Vec2(-1, 0.2));
  CHECK(floor.robots[0].heading_rad == 1);
  CHECK(floor.robots[1].team == Team::kYellow);
  CHECK(floor.robots[1].pattern == 4);
  REQUIRE(floor.cylinders.size() == 2);
  CHECK(floor.cylinders[0].circle.radius_m == 0.2);
  CHECK(floor.cylinders[1].circle.centre_m == Vec2(0, 1.2));
  REQUIRE(floor.ball);
  CHECK(floor.ball->position_m.head<2>() == Vec2(0.6, 0.4));
  CHECK(floor_scene(scenario, World(scenario, ImageSystem::kBegin, 1)).robots.size() == 2);
}

TEST_CASE("each camera's images arrive at its rate and after its delay, without detections") {
  ImageSystem system(parse_scenario(kFloor, "floor.yaml"));
  system.network.run_until(ImageSystem::kBegin + std::chrono::seconds(1));
  REQUIRE(system.images.size() == 2);
  for (const auto& [camera, images] : system.images) {
    CAPTURE(camera);
    CHECK(images.size() >= 56);
    CHECK(images.size() <= 60);
    for (std::size_t i = 1; i < images.size(); ++i) {
      const auto apart_ns = images[i].captured_at_ns() - images[i - 1].captured_at_ns();
      CHECK(apart_ns >= 16'000'000);
      CHECK(apart_ns <= 17'700'000);
    }
    CHECK(images[0].width_px() == 200);
    CHECK(images[0].height_px() == 150);
    CHECK(images[0].image_format() == msg::ImageFormat::IMAGE_YUV422);
    CHECK(images[0].pixels().size() == 200 * 150 * 2);
    CHECK(images[0].header().incarnation() == 7);
  }
  for (const Duration late : system.late) {
    CHECK(late >= std::chrono::milliseconds(25));
    CHECK(late <= std::chrono::milliseconds(26));
  }
  CHECK(system.detections == 0);
}

TEST_CASE("an image shows the objects in its camera's view") {
  Scenario scenario = parse_scenario(kFloor, "floor.yaml");
  scenario.ball.reset();
  scenario.opponents.clear();
  ImageSystem system(scenario);
  system.network.run_until(ImageSystem::kBegin + std::chrono::milliseconds(100));
  const std::vector<CameraModel> cameras = camera_grid(scenario);
  for (std::size_t camera = 0; camera < 2; ++camera) {
    CAPTURE(camera);
    REQUIRE(!system.images[static_cast<std::uint32_t>(camera)].empty());
    const auto& pixels = system.images[static_cast<std::uint32_t>(camera)].front().pixels();
    const auto difference = [&](const std::vector<std::uint8_t>& other) {
      double sum = 0;
      for (std::size_t i = 0; i < other.size(); ++i) sum += std::abs(pixels[i] - other[i]);
      return sum / static_cast<double>(other.size());
    };
    // The images differ only by noise and the texture of the field surface.
    CHECK(difference(rendered(scenario, cameras[camera])) < 4);
    CHECK(difference(rendered(scenario, cameras[camera])) <
          0.8 * difference(rendered(scenario, cameras[1 - camera])));
  }
}

}  // namespace sidestep::image_output_test
