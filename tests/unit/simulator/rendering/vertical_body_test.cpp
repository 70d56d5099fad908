// SPDX-License-Identifier: Apache-2.0
#include "simulator/rendering/vertical_body.hpp"

#include <cmath>
#include <fmt/format.h>
#include <vector>

#include "common/camera/overhead_camera.hpp"
#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::vertical_body_test {

const Light kGround(40, 100, 50);

Canvas empty_canvas(const CameraModel& camera) {
  Canvas canvas(camera.parameters().height_px, camera.parameters().width_px);
  canvas = bytes_of(kGround);
  return canvas;
}

bool is_in_cross_section(const VerticalBody& body, const Vec2& p) {
  return p.norm() <= body.radius_m && p.x() <= body.front_m;
}

/// The light at a point of the image, found by following its viewing ray from the top down in small steps.
Light reference_light(const VerticalBody& body, const CameraModel& camera, const Vec2& pixel) {
  const auto in_frame = [&](double height_m) {
    return rotated(*camera.point_at(pixel, height_m) - body.position_m, -body.heading_rad);
  };
  const Vec2 top = in_frame(body.height_m), floor = in_frame(0);
  if (is_in_cross_section(body, top)) {
    for (const TopDot& dot : body.dots)
      if ((top - dot.position_m).norm() <= dot.radius_m) return dot.light;
    return body.top;
  }
  constexpr int kSteps = 400;
  for (int i = 1; i <= kSteps; ++i)
    if (is_in_cross_section(body, top + (floor - top) * i / kSteps)) return body.side;
  return kGround;
}

Light reference_pixel(const VerticalBody& body, const CameraModel& camera, int x, int y) {
  constexpr int kSteps = 12;
  Light sum(0, 0, 0);
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j)
      sum += reference_light(body, camera, Vec2(x + (i + 0.5) / kSteps - 0.5, y + (j + 0.5) / kSteps - 0.5));
  return sum / (kSteps * kSteps);
}

const std::vector<TopDot> kDots{{{0, 0}, 0.025, Light(20, 80, 220)},
                                {{0.035, 0.054}, 0.018, Light(240, 60, 160)},
                                {{0.035, -0.054}, 0.018, Light(70, 220, 80)},
                                {{-0.054, 0.035}, 0.018, Light(240, 60, 160)},
                                {{-0.054, -0.035}, 0.018, Light(70, 220, 80)}};

VerticalBody random_body(const Box& view_m, Rng& rng) {
  VerticalBody body;
  body.position_m = {rng.uniform(view_m.min_m.x(), view_m.max_m.x()),
                     rng.uniform(view_m.min_m.y(), view_m.max_m.y())};
  body.heading_rad = rng.uniform(-3, 3);
  body.front_m = rng.chance(0.7) ? 0.055 : 1e3;
  body.height_m = rng.uniform(0.02, 0.3);
  body.top = Light(20, 22, 24);
  body.side = Light(60, 30, 90);
  body.dots = kDots;
  return body;
}

OverheadCamera random_camera(Rng& rng) {
  OverheadCamera overhead_camera;
  overhead_camera.view_m = {{-1.2, -0.9}, {1.2, 0.9}};
  overhead_camera.height_m = rng.uniform(1.5, 4);
  overhead_camera.lateral_offset_m = {rng.uniform(-1, 1), rng.uniform(-1, 1)};
  overhead_camera.width_px = 320;
  overhead_camera.height_px = 240;
  return overhead_camera;
}

TEST_CASE("a drawn body agrees with individually traced viewing rays") {
  const std::uint64_t seed = 51;
  CAPTURE(seed);
  Rng rng(seed);
  double squares = 0;
  int edges = 0;
  for (int i = 0; i < 25; ++i) {
    CAPTURE(i);
    const OverheadCamera overhead_camera = random_camera(rng);
    const CameraModel camera = overhead_camera_model(overhead_camera);
    const VerticalBody body = random_body(overhead_camera.view_m, rng);
    Canvas canvas = empty_canvas(camera);
    const cv::Rect rect = draw(body, camera, 0, canvas);
    REQUIRE(!rect.empty());
    for (int y = 0; y < canvas.rows; ++y) {
      for (int x = 0; x < canvas.cols; ++x) {
        if (!rect.contains({x, y})) {
          REQUIRE(light_of(canvas(y, x)) == kGround);
          continue;
        }
        const Light expected = reference_pixel(body, camera, x, y);
        const double error = (expected - light_of(canvas(y, x))).cwiseAbs().maxCoeff();
        CAPTURE(x, y, canvas(y, x), expected.transpose());
        // draw() takes 128 samples and the reference takes 144, so they differ at an edge of 220 levels.
        REQUIRE(error <= 16);
        if (error == 0) continue;
        squares += error * error;
        ++edges;
      }
    }
  }
  INFO(fmt::format("RMS {:.2f} levels over {} pixels", std::sqrt(squares / edges), edges));
  CHECK(std::sqrt(squares / edges) < 3);
}

TEST_CASE("draw changes only pixels in the returned rectangle, which lies within the image") {
  const std::uint64_t seed = 52;
  CAPTURE(seed);
  Rng rng(seed);
  int partly = 0, outside = 0;
  for (int i = 0; i < 2000; ++i) {
    const OverheadCamera overhead_camera = random_camera(rng);
    const CameraModel camera = overhead_camera_model(overhead_camera);
    const VerticalBody body = random_body(inflated(overhead_camera.view_m, 1), rng);
    Canvas canvas = empty_canvas(camera);
    const cv::Rect rect = draw(body, camera, 0, canvas);
    const cv::Rect image(0, 0, canvas.cols, canvas.rows);
    REQUIRE((rect & image) == rect);
    ++(rect.empty() ? outside : partly);
    if (i % 20 != 0) continue;
    Canvas masked = canvas.clone();
    masked(rect) = bytes_of(kGround);
    REQUIRE(cv::countNonZero(masked.reshape(1) != empty_canvas(camera).reshape(1)) == 0);
  }
  CHECK(partly > 100);
  CHECK(outside > 100);
}

TEST_CASE("a body that moves during the exposure looks like the mean over its positions") {
  const std::uint64_t seed = 53;
  CAPTURE(seed);
  Rng rng(seed);
  for (int i = 0; i < 8; ++i) {
    const OverheadCamera overhead_camera = random_camera(rng);
    const CameraModel camera = overhead_camera_model(overhead_camera);
    VerticalBody body = random_body(inflated(overhead_camera.view_m, -0.2), rng);
    body.velocity_mps = {rng.uniform(-2, 2), rng.uniform(-2, 2)};
    body.angular_radps = rng.uniform(-6, 6);
    const double exposure_s = 0.01;
    Canvas blurred = empty_canvas(camera);
    draw(body, camera, exposure_s, blurred);
    cv::Mat3f sum(blurred.size(), cv::Vec3f(0, 0, 0));
    constexpr int kInstants = 101;
    for (int j = 0; j < kInstants; ++j) {
      const double t = exposure_s * ((j + 0.5) / kInstants - 0.5);
      VerticalBody still = body;
      still.position_m += t * body.velocity_mps;
      still.heading_rad += t * body.angular_radps;
      still.velocity_mps = {0, 0};
      still.angular_radps = 0;
      Canvas sharp = empty_canvas(camera);
      draw(still, camera, 0, sharp);
      cv::Mat3f exact;
      sharp.convertTo(exact, CV_32F);
      sum += exact / kInstants;
    }
    cv::Mat3f exact;
    blurred.convertTo(exact, CV_32F);
    double max_error = 0, squares = 0;
    int changed = 0;
    for (int y = 0; y < sum.rows; ++y) {
      for (int x = 0; x < sum.cols; ++x) {
        const cv::Vec3f d = sum(y, x) - exact(y, x);
        const double error = std::max({std::abs(d[0]), std::abs(d[1]), std::abs(d[2])});
        max_error = std::max(max_error, error);
        squares += error * error;
        changed += error > 0.01;
      }
    }
    INFO(fmt::format("max {:.1f}, RMS {:.2f} levels over {} pixels", max_error, std::sqrt(squares / changed),
                     changed));
    CHECK(max_error < 24);
    CHECK(std::sqrt(squares / changed) < 4);
  }
}

}  // namespace sidestep::vertical_body_test
