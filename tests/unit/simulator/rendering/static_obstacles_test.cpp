// SPDX-License-Identifier: Apache-2.0
#include "simulator/rendering/static_obstacles.hpp"

#include <cmath>

#include "common/marking/butterfly.hpp"
#include "simulator/rendering/field_surface.hpp"
#include "tests/catch.hpp"
#include "tests/unit/simulator/rendering/plain_spec.hpp"

namespace sidestep::static_obstacles_test {

constexpr int kWidth_px = 160, kHeight_px = 120;
constexpr double kSideBrightness = 0.55;

CameraModel small_camera() {
  OverheadCamera overhead = quarter_field();
  overhead.width_px = kWidth_px;
  overhead.height_px = kHeight_px;
  return overhead_camera_model(overhead);
}

ConvexPolygon random_triangle(const Vec2& centre_m, Rng& rng) {
  const double turn = rng.uniform(-3, 3), size_m = rng.uniform(0.1, 0.5);
  ConvexPolygon triangle;
  for (const double angle : {0.0, 1.9, 4.1})
    triangle.corners_m.push_back(centre_m + size_m * rotated({1, 0}, turn + angle));
  return triangle;
}

Vec2 random_point(double half_x_m, double half_y_m, Rng& rng) {
  const double x = rng.uniform(-half_x_m, half_x_m), y = rng.uniform(-half_y_m, half_y_m);
  return {x, y};
}

StaticScene random_scene(Rng& rng) {
  StaticScene scene;
  for (int i = 0; i < 3; ++i) {
    const Vec2 corner_m = random_point(2.5, 1.8, rng), side_m = Vec2(0.7, 0.7) + random_point(0.6, 0.6, rng);
    scene.shapes.emplace_back(Box{corner_m, corner_m + side_m});
    scene.shapes.emplace_back(random_triangle(random_point(2.5, 1.8, rng), rng));
    const Vec2 from_m = random_point(2.5, 1.8, rng), to_m = random_point(2.5, 1.8, rng);
    scene.shapes.emplace_back(Segment{from_m, to_m});
  }
  MapGrid grid;
  grid.columns = 56;
  grid.rows = 42;
  grid.resolution_m = 0.1;
  grid.origin_m = {-2.8, -2.1};
  BitGrid blocked(grid.columns, grid.rows);
  for (int i = 0; i < 60; ++i) {
    const auto column = static_cast<int>(rng.below(56)), row = static_cast<int>(rng.below(42));
    blocked.set(column, row);
  }
  if (rng.chance(0.5)) scene.map = std::make_shared<FloorMap>(OccupancyMap(grid, blocked));
  return scene;
}

/// Slow reference: whether a point lies in any obstacle, by the definitions of the shapes alone.
bool is_in_obstacle(const StaticScene& scene, const Vec2& p) {
  for (const Shape& shape : scene.shapes) {
    if (const auto* box = std::get_if<Box>(&shape)) {
      if (p.x() >= box->min_m.x() && p.x() <= box->max_m.x() && p.y() >= box->min_m.y() &&
          p.y() <= box->max_m.y())
        return true;
    } else if (const auto* polygon = std::get_if<ConvexPolygon>(&shape)) {
      bool is_odd = false;
      const auto& corners = polygon->corners_m;
      for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec2 a = corners[i], b = corners[(i + 1) % corners.size()];
        if ((a.y() > p.y()) != (b.y() > p.y()) &&
            p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
          is_odd = !is_odd;
      }
      if (is_odd) return true;
    } else if (const auto* segment = std::get_if<Segment>(&shape)) {
      const Vec2 along = segment->to_m - segment->from_m;
      const double share = std::min(1.0, std::max(0.0, along.dot(p - segment->from_m) / along.dot(along)));
      if ((segment->from_m + share * along - p).norm() <= kBoardHalfThickness_m) return true;
    }
  }
  if (!scene.map) return false;
  const MapGrid& grid = scene.map->cells().grid();
  const double column = std::floor((p.x() - grid.origin_m.x()) / grid.resolution_m);
  const double row = std::floor((p.y() - grid.origin_m.y()) / grid.resolution_m);
  if (column < 0 || row < 0 || column >= grid.columns || row >= grid.rows) return true;
  return scene.map->cells().blocked().get(static_cast<int>(column), static_cast<int>(row));
}

/// The brightness of the obstacle on a viewing ray relative to that of the obstacle's top; 0 if the ray meets
/// none. Follows the ray down in steps.
double reference_brightness(const StaticScene& scene, const CameraModel& camera, const Vec2& pixel) {
  constexpr int kSteps = 60;
  for (int step = 0; step <= kSteps; ++step) {
    const double height_m = scene.height_m * (1 - step / double{kSteps});
    if (is_in_obstacle(scene, *camera.point_at(pixel, height_m))) return step == 0 ? 1 : kSideBrightness;
  }
  return 0;
}

TEST_CASE("a pixel has the mean colour of the obstacles and the floor that its viewing rays hit") {
  const CameraModel camera = small_camera();
  const Field field{12, 9};
  int mixed = 0, covered = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Rng rng(seed);
    const StaticScene scene = random_scene(rng);
    Rng texture(1);
    const Canvas empty = render_floor(camera, field, plain_spec(), texture);
    Canvas canvas = empty.clone();
    const StaticOcclusion cover = draw_static(scene, camera, field, plain_spec(), canvas);
    for (int i = 0; i < 250; ++i) {
      const auto x = static_cast<int>(rng.below(kWidth_px)), y = static_cast<int>(rng.below(kHeight_px));
      constexpr int kGrid = 12;
      double light = 0, share = 0;
      for (int k = 0; k < kGrid * kGrid; ++k) {
        const Vec2 pixel(x + (k % kGrid + 0.5) / kGrid - 0.5, y + (k / kGrid + 0.5) / kGrid - 0.5);
        const double brightness = reference_brightness(scene, camera, pixel);
        light += brightness / (kGrid * kGrid);
        share += (brightness > 0 ? 1.0 : 0.0) / (kGrid * kGrid);
      }
      CAPTURE(seed, x, y, share, light);
      // 144 rays against 128 samples, with steps of 2.5 mm, differ by a few hundredths of a pixel.
      REQUIRE(std::abs(cover.samples(y, x) / 128.0 - share) < 0.06);
      for (int channel = 0; channel < 3; ++channel) {
        const double colour = channel == 0 ? scene.colour.r : channel == 1 ? scene.colour.g : scene.colour.b;
        const double expected = light * colour + (1 - share) * empty(y, x)[channel];
        REQUIRE(std::abs(canvas(y, x)[channel] - expected) < 9);
      }
      mixed += share > 0.05 && share < 0.95;
      covered += share > 0.999;
    }
  }
  CHECK(mixed > 100);
  CHECK(covered > 200);
}

TEST_CASE("the outside of a map and all its blocked cells are drawn over the whole image") {
  StaticScene scene;
  scene.map = std::make_shared<FloorMap>(OccupancyMap(MapGrid{1, 1, 0.5, {-10, -10}}, BitGrid(1, 1)));
  const CameraModel camera = small_camera();
  Canvas canvas(kHeight_px, kWidth_px, cv::Vec3b(0, 0, 0));
  const StaticOcclusion cover = draw_static(scene, camera, Field{12, 9}, plain_spec(), canvas);
  for (int y = 0; y < kHeight_px; ++y)
    for (int x = 0; x < kWidth_px; ++x) REQUIRE(cover.samples(y, x) == 128);
}

TEST_CASE("without static obstacles, the image does not change") {
  Canvas canvas(kHeight_px, kWidth_px, cv::Vec3b(1, 2, 3));
  CHECK(draw_static({}, small_camera(), Field{12, 9}, plain_spec(), canvas).samples.empty());
  CHECK(canvas(5, 5) == cv::Vec3b(1, 2, 3));
}

TEST_CASE("a wall hides objects behind it, and a robot in front hides the wall") {
  // Seen from the side; the camera is far to the left above the floor:   robot | wall | cylinder
  const CameraModel camera = overhead_camera_model(quarter_field());
  const Field field{12, 9};
  StaticScene statics;
  statics.shapes.emplace_back(Box{{2.2, -1}, {2.3, 1}});
  FrameRenderer with_wall(camera, field, butterfly(), plain_spec(), Rng(1), statics);
  FrameRenderer without_wall(camera, field, butterfly(), plain_spec(), Rng(1));
  SceneRobot robot;
  robot.position_m = {2.2 - 0.1, 0.5};
  const SceneCylinder low{{{2.4, -0.5}, 0.08}, 0.05, {200, 30, 30}};
  Image wall_only = with_wall.render(Scene{});
  Image both = with_wall.render(Scene{{&robot, 1}, {&low, 1}});
  Image objects_only = without_wall.render(Scene{{&robot, 1}, {&low, 1}});
  Image floor_only = without_wall.render(Scene{});
  int top_pixels = 0, hidden = 0, robot_pixels = 0;
  for (int y = 0; y < 580; ++y) {
    for (int x = 0; x < 780; ++x) {
      const auto top_m = camera.point_at(Vec2(x, y), statics.height_m);
      const double inside_m = -signed_distance(*top_m, statics.shapes[0]);
      const cv::Vec3b seen = rgb_of(both)(y, x);
      CAPTURE(x, y);
      if (inside_m > 0.012) {
        REQUIRE(seen == rgb_of(wall_only)(y, x));
        ++top_pixels;
        hidden += rgb_of(objects_only)(y, x) != rgb_of(floor_only)(y, x);
      } else if ((*top_m - robot.position_m).norm() < 0.045) {
        REQUIRE(seen == rgb_of(objects_only)(y, x));
        ++robot_pixels;
      }
    }
  }
  CHECK(top_pixels > 1000);
  CHECK(hidden > 20);
  CHECK(robot_pixels > 80);
  // The next frame shows the wall as before.
  Image again = with_wall.render(Scene{});
  CHECK(cv::norm(rgb_of(again), rgb_of(wall_only), cv::NORM_INF) == 0);
}

}  // namespace sidestep::static_obstacles_test
