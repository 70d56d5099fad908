// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "common/camera/overhead_camera.hpp"
#include "common/marking/butterfly.hpp"
#include "simulator/rendering/frame_renderer.hpp"
#include "tests/catch.hpp"
#include "vision/colours/default_colours.hpp"
#include "vision/pixel_map/pixel_cells.hpp"
#include "vision/segmentation/segmenter.hpp"

namespace sidestep::pixel_map_test {

constexpr Field kField{5.4, 4};
constexpr int kWidth_px = 800, kHeight_px = 600;

CameraModel camera_over_field() {
  OverheadCamera overhead;
  overhead.width_px = kWidth_px;
  overhead.height_px = kHeight_px;
  return overhead_camera_model(overhead);
}

FloorBlobSettings settings_of(const CameraModel& camera) {
  FloorBlobSettings settings;
  settings.below_camera_px = *camera.pixel_of({0, 0, 0});
  settings.foot_distance_ratio = 1 - SceneCylinder{}.height_m / camera.position_m().z();
  return settings;
}

/// A random floor: cylinders that keep a distance from each other, the robot and the target.
struct RandomFloor {
  explicit RandomFloor(std::uint64_t seed) : rng(seed) {
    robot.position_m = {-2.3, place(-1.5, 1.5)};
    robot.heading_rad = place(-3, 3);
    ball.position_m.head<2>() = Vec2(2.3, place(-1.5, 1.5));
    for (int i = 0; i < 5; ++i) {
      SceneCylinder cylinder;
      cylinder.circle.centre_m = {-1.4 + 0.7 * i, place(-1.4, 1.4)};
      cylinder.circle.radius_m = place(0.06, 0.25);
      cylinders.push_back(cylinder);
    }
  }
  double place(double low, double high) { return rng.uniform(low, high); }
  Image image(const CameraModel& camera) {
    FrameRenderer renderer(camera, kField, butterfly(), RenderSpec{}, Rng(rng.bits()));
    return renderer.render({{&robot, 1}, cylinders, ball});
  }

  Rng rng;
  SceneRobot robot;
  SceneBall ball;
  std::vector<SceneCylinder> cylinders;
};

/// Pixels on the edge of a cylinder's base.
std::vector<Vec2> base_pixels(const SceneCylinder& cylinder, const CameraModel& camera) {
  std::vector<Vec2> pixels;
  for (int i = 0; i < 64; ++i) {
    const Vec2 p = cylinder.circle.centre_m + cylinder.circle.radius_m * rotated({1, 0}, 0.1 * i);
    pixels.push_back(*camera.pixel_of({p.x(), p.y(), 0}));
  }
  return pixels;
}

/// Slow reference: the distance from a point to a convex polygon; 0 inside.
double distance_px(const Vec2& p, const std::array<Vec2, 4>& corners) {
  double nearest = 1e9;
  int left = 0, right = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec2 a = corners[i], b = corners[(i + 1) % 4];
    (cross(b - a, p - a) > 0 ? left : right) += 1;
    for (int k = 0; k <= 200; ++k) nearest = std::min(nearest, (a + k / 200.0 * (b - a) - p).norm());
  }
  return left == 4 || right == 4 ? 0 : nearest;
}

TEST_CASE("robot, target and obstacles are found, and diamonds and discs contain the obstacles' bases") {
  const CameraModel camera = camera_over_field();
  Segmenter segmenter(ColourClasses(default_colours(PixelFormat::kYuv422).boxes), {3, 1});
  FloorBlobFinder finder(settings_of(camera));
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    RandomFloor floor(seed);
    const Image image = floor.image(camera);
    const FloorBlobs& blobs = finder.find(image.view(), segmenter.classes(), segmenter.segment(image.view()));
    CAPTURE(seed);
    const Vec2& at_m = floor.robot.position_m;
    REQUIRE(blobs.robot);
    CHECK((*blobs.robot - *camera.pixel_of({at_m.x(), at_m.y(), 0.15})).norm() < 0.7);
    REQUIRE(blobs.target);
    CHECK((*blobs.target - *camera.pixel_of(floor.ball.position_m)).norm() < 1);
    REQUIRE(blobs.obstacles.size() == floor.cylinders.size());
    for (const SceneCylinder& cylinder : floor.cylinders) {
      const Vec2 middle = *camera.pixel_of({cylinder.circle.centre_m.x(), cylinder.circle.centre_m.y(), 0});
      const ObstacleBlob& blob = *std::ranges::min_element(
          blobs.obstacles, {}, [&](const ObstacleBlob& one) { return (one.centre - middle).norm(); });
      for (const Vec2& pixel : base_pixels(cylinder, camera)) {
        // Thresholds may lose the outermost half pixel.
        REQUIRE(distance_px(pixel, blob.diamond) < 1);
        REQUIRE((pixel - blob.centre).norm() < blob.radius_px + 1);
      }
      // The disc is not much larger than the obstacle's image, which includes its height.
      const double radius_px = cylinder.circle.radius_m * 133;
      REQUIRE(blob.radius_px < radius_px + 22);
    }
  }
}

TEST_CASE("a robot or target that is missing or seen twice is not reported") {
  const CameraModel camera = camera_over_field();
  Segmenter segmenter(ColourClasses(default_colours(PixelFormat::kYuv422).boxes), {3, 1});
  FloorBlobFinder finder(settings_of(camera));
  FrameRenderer renderer(camera, kField, butterfly(), RenderSpec{}, Rng(1));
  std::array<SceneRobot, 2> robots;
  robots[1].position_m = {1, 1};
  for (const std::size_t count : {0u, 1u, 2u}) {
    const Image image = renderer.render({std::span(robots).first(count)});
    const FloorBlobs& blobs = finder.find(image.view(), segmenter.classes(), segmenter.segment(image.view()));
    CAPTURE(count);
    CHECK(blobs.robot.has_value() == (count == 1));
    CHECK_FALSE(blobs.target.has_value());
    // Robots that cannot be distinguished are obstacles.
    CHECK(blobs.obstacles.empty() == (count < 2));
  }
}

TEST_CASE("a disc centred anywhere in a free cell touches no obstacle and stays in the image") {
  const CameraModel camera = camera_over_field();
  Segmenter segmenter(ColourClasses(default_colours(PixelFormat::kYuv422).boxes), {3, 1});
  FloorBlobFinder finder(settings_of(camera));
  int free = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    RandomFloor floor(seed);
    const Image image = floor.image(camera);
    const double radius_px = floor.place(8, 25);
    const FloorBlobs& blobs = finder.find(image.view(), segmenter.classes(), segmenter.segment(image.view()));
    PixelCells cells(kWidth_px, kHeight_px);
    CHECK(cells.seen.columns() * cells.seen.rows() == 4800);
    mark_cells(image.view(), segmenter.classes(), finder, blobs.obstacles, radius_px, cells);
    for (int i = 0; i < 3000; ++i) {
      const double x = floor.place(-0.5, kWidth_px - 0.5), y = floor.place(-0.5, kHeight_px - 0.5);
      const Cell cell = cells.cell_at({x, y});
      CAPTURE(seed, x, y, radius_px);
      REQUIRE(std::abs(cells.centre_of(cell).x() - x) <= 5);
      REQUIRE(std::abs(cells.centre_of(cell).y() - y) <= 5);
      if (cells.blocked.get(cell.column, cell.row)) continue;
      ++free;
      REQUIRE(x - radius_px >= -0.5);
      REQUIRE(y - radius_px >= -0.5);
      REQUIRE(x + radius_px <= kWidth_px - 0.5);
      REQUIRE(y + radius_px <= kHeight_px - 0.5);
      for (const SceneCylinder& cylinder : floor.cylinders)
        for (const Vec2& pixel : base_pixels(cylinder, camera))
          REQUIRE((pixel - Vec2(x, y)).norm() > radius_px - 1.5);
    }
  }
  CHECK(free > 10000);
}

}  // namespace sidestep::pixel_map_test
