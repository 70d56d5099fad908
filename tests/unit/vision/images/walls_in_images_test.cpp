// SPDX-License-Identifier: Apache-2.0
#include "common/camera/camera_grid.hpp"
#include "common/config/scenario_loader.hpp"
#include "common/marking/butterfly.hpp"
#include "simulator/images/floor_scene.hpp"
#include "simulator/rendering/frame_renderer.hpp"
#include "tests/catch.hpp"
#include "vision/images/image_options.hpp"
#include "vision/images/image_reader.hpp"

namespace sidestep::walls_in_images_test {

constexpr Time kNow = time_from_ns(5'010'000'000);
const Rgb kBrown{150, 96, 56};

//   ####### outside of the map #######
//   #    box      |  triangle        #
//   #    cells    wall      board    #
const std::string kFloor = R"(
field: {length_m: 6, width_m: 4.5}
vision: {columns: 1, images: {}}
robots: [{id: 0, team: blue, start_m: [0, 0], goals_m: [[1, 0]]}]
obstacles:
  - box: {min_m: [-2.0, 0.8], max_m: [-1.2, 1.1]}
  - polygon: {corners_m: [[0.9, 0.7], [1.6, 0.9], [1.1, 1.4]]}
  - wall: {points_m: [[0.2, 2.0], [0.2, 0.9], [0.7, 0.3]], thickness_m: 0.08}
  - segment: {from_m: [1.2, -1.2], to_m: [2.2, -0.8]}
)";

Scenario floor_with_walls(std::uint64_t seed) {
  Scenario scenario = parse_scenario(kFloor, "floor.yaml");
  Rng rng(seed);
  BitGrid blocked(56, 40);
  for (int i = 0; i < 12; ++i) {
    const auto column = static_cast<int>(rng.below(20)), row = static_cast<int>(rng.below(14));
    blocked.set(column, row);
  }
  scenario.map = std::make_shared<FloorMap>(OccupancyMap(MapGrid{56, 40, 0.1, {-2.8, -2}}, blocked));
  return scenario;
}

double clearance_m(const Scenario& scenario, const Vec2& p) {
  double nearest_m = scenario.map->cells().distance_m(p);
  for (const Shape& shape : scenario.obstacles) nearest_m = std::min(nearest_m, signed_distance(p, shape));
  return nearest_m;
}

/// A random position whose distance from the nearest wall is `extra_m` to 3 cm more, and which is far from
/// `others`.
Vec2 place_beside_walls(const Scenario& scenario, double extra_m, const std::vector<Vec2>& others, Rng& rng) {
  while (true) {
    const double x = rng.uniform(-2.7, 2.7), y = rng.uniform(-1.9, 1.9);
    const Vec2 p(x, y);
    const double clear_m = clearance_m(scenario, p);
    if (clear_m < extra_m || clear_m > extra_m + 0.03) continue;
    if (std::ranges::all_of(others, [&](const Vec2& other) { return (other - p).norm() > 0.7; })) return p;
  }
}

msg::DetectionFrame detected(const Scenario& scenario, const StaticScene& statics, std::uint64_t seed) {
  const CameraModel camera = camera_grid(scenario)[0];
  RenderSpec spec;
  spec.format = scenario.vision.images->format;
  FrameRenderer renderer(camera, scenario.field, butterfly(), spec, Rng(seed), statics);
  const Image image = renderer.render(floor_scene(scenario).scene());
  msg::CameraImage message;
  message.captured_at_ns(5'000'000'000);
  message.image_format(spec.format == PixelFormat::kRgb ? msg::ImageFormat::IMAGE_RGB
                                                        : msg::ImageFormat::IMAGE_YUV422);
  message.width_px(static_cast<std::uint32_t>(image.view().width_px));
  message.height_px(static_cast<std::uint32_t>(image.view().height_px));
  message.pixels().assign(image.view().pixels, image.view().pixels + image.view().bytes());
  ImageReader reader = image_reader(scenario, {});
  msg::DetectionFrame frame;
  REQUIRE(reader.read(message, kNow, {}, frame));
  return frame;
}

TEST_CASE("robots and people close to walls and map cells are found, and no other objects", "[slow]") {
  const auto format = GENERATE(PixelFormat::kYuv422, PixelFormat::kRgb);
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Scenario scenario = floor_with_walls(seed);
    scenario.vision.images->format = format;
    Rng rng(seed);
    std::vector<Vec2> places;
    scenario.robots.resize(4, scenario.robots[0]);
    for (RobotId id = 0; id < 4; ++id) {
      RobotSpec& robot = scenario.robots[id];
      robot.id = id;
      robot.team = id % 2 == 0 ? Team::kBlue : Team::kYellow;
      robot.start_m = place_beside_walls(scenario, 0.1, places, rng);
      robot.start_heading_rad = rng.uniform(-3, 3);
      places.push_back(robot.start_m);
    }
    for (int i = 0; i < 2; ++i) {
      OpponentSpec person;
      person.radius_m = 0.2;
      person.path_m = {place_beside_walls(scenario, 0.21, places, rng)};
      places.push_back(person.path_m[0]);
      scenario.opponents.push_back(person);
    }
    const msg::DetectionFrame frame = detected(scenario, static_scene(scenario), seed);
    CAPTURE(format, seed);
    REQUIRE(frame.robots().size() == 4);
    for (const msg::RobotDetection& found : frame.robots()) {
      const RobotSpec& robot = *find_robot(scenario, found.robot());
      REQUIRE(std::hypot(found.x_m() - robot.start_m.x(), found.y_m() - robot.start_m.y()) < 0.004);
    }
    REQUIRE(frame.ball_count() == 0);
    REQUIRE(frame.obstacle_count() == 2);
    for (const OpponentSpec& person : scenario.opponents) {
      const auto& list = frame.obstacles();
      REQUIRE(std::any_of(list.begin(), list.begin() + frame.obstacle_count(), [&](const auto& found) {
        // A wall in front of a person may hide the person's foot. The circle then lies farther from the
        // camera.
        return std::hypot(found.x_m() - person.path_m[0].x(), found.y_m() - person.path_m[0].y()) < 0.1 &&
               std::abs(found.radius_m() - person.radius_m) < 0.05;
      }));
    }
  }
}

TEST_CASE("walls and map cells of any colour are not reported as obstacles") {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Scenario scenario = floor_with_walls(seed);
    StaticScene statics = static_scene(scenario);
    statics.colour = kBrown;
    CAPTURE(seed);
    const msg::DetectionFrame frame = detected(scenario, statics, seed);
    REQUIRE(frame.robots().size() == 1);
    REQUIRE(frame.obstacle_count() == 0);
    // The walls are visible: a reader that does not know them reports them.
    statics.map.reset();
    scenario.map.reset();
    scenario.obstacles.clear();
    REQUIRE(detected(scenario, statics, seed).obstacle_count() > 0);
  }
}

}  // namespace sidestep::walls_in_images_test
