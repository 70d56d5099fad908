// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>
#include <vector>

#include "common/camera/camera_grid.hpp"
#include "common/marking/butterfly.hpp"
#include "common/random/rng.hpp"
#include "simulator/rendering/frame_renderer.hpp"

using namespace sidestep;

namespace {

const Field kField{12, 9};

/// One of four cameras over a division A field.
CameraModel quarter(int width_px, int height_px) {
  VisionSpec spec;
  spec.columns = spec.rows = 2;
  spec.overlap_m = 0.25;
  OverheadCamera camera;
  camera.width_px = width_px;
  camera.height_px = height_px;
  return camera_grid(kField, spec, camera)[0];
}

std::vector<Vec3> random_points() {
  Rng rng(1);
  std::vector<Vec3> points;
  for (int i = 0; i < 1024; ++i) {
    const double y = rng.uniform(-4.5, 0), x = rng.uniform(-6, 0);
    points.emplace_back(x, y, 0.15);
  }
  return points;
}

void pixel_of_point(benchmark::State& state) {
  const CameraModel camera = quarter(780, 580);
  const std::vector<Vec3> points = random_points();
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(camera.pixel_of(points[i++ % 1024]));
}

void point_of_pixel(benchmark::State& state) {
  const CameraModel camera = quarter(780, 580);
  Rng rng(1);
  std::vector<Vec2> pixels;
  for (int i = 0; i < 1024; ++i) {
    const double y = rng.uniform(0, 580), x = rng.uniform(0, 780);
    pixels.emplace_back(x, y);
  }
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(camera.point_at(pixels[i++ % 1024], 0.15));
}

void jacobian_of_point(benchmark::State& state) {
  const CameraModel camera = quarter(780, 580);
  const std::vector<Vec3> points = random_points();
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(camera.projection_jacobian(points[i++ % 1024]));
}

/// Arguments: width, height, RGB or YUV, number of robots, all in the camera's view.
void frame(benchmark::State& state) {
  RenderSpec spec;
  spec.format = state.range(2) != 0 ? PixelFormat::kRgb : PixelFormat::kYuv422;
  FrameRenderer renderer(quarter(int(state.range(0)), int(state.range(1))), kField, butterfly(), spec,
                         Rng(1));
  Rng rng(2);
  std::vector<SceneRobot> robots;
  for (std::uint32_t i = 0; i < state.range(3); ++i) {
    const std::uint32_t column = i % 6, row = i / 6;
    const Vec2 place(-5.8 + 1.1 * column, -4.2 + 1.1 * row);
    robots.push_back({i % 2 == 0 ? Team::kBlue : Team::kYellow, i % 16, place, rng.uniform(-3, 3)});
  }
  const Scene scene{robots, {}, SceneBall{Vec3(-3.3, -2.5, 0.0215)}};
  Image image = renderer.render(scene);
  for (auto _ : state) {
    renderer.render(scene, image.pixels());
    benchmark::DoNotOptimize(image.pixels());
  }
}

}  // namespace

BENCHMARK(pixel_of_point);
BENCHMARK(point_of_pixel);
BENCHMARK(jacobian_of_point);
BENCHMARK(frame)
    ->Unit(benchmark::kMillisecond)
    ->ArgNames({"width", "height", "rgb", "robots"})
    ->ArgsProduct({{780}, {580}, {0, 1}, {0, 6, 22}})
    ->ArgsProduct({{2448}, {2048}, {0, 1}, {6}});
