// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <fmt/format.h>

#include "common/marking/butterfly.hpp"
#include "simulator/rendering/round_ball.hpp"
#include "tests/catch.hpp"
#include "tests/unit/simulator/rendering/plain_spec.hpp"

namespace sidestep::dot_centroid_test {

/// The centroid of the difference between two frames.
Vec2 centroid_of_difference(const cv::Mat3b& a, const cv::Mat3b& b, int channel) {
  double sum = 0, x_sum = 0, y_sum = 0;
  for (int y = 0; y < a.rows; ++y) {
    for (int x = 0; x < a.cols; ++x) {
      const double weight = a(y, x)[channel] - b(y, x)[channel];
      sum += weight;
      x_sum += weight * x;
      y_sum += weight * y;
    }
  }
  return {x_sum / sum, y_sum / sum};
}

/// The centroid of a disc's image: the disc's points are projected individually and weighted by the local
/// scale of the image.
Vec2 centroid_of_disc(const CameraModel& camera, const Vec2& centre_m, double height_m, double radius_m) {
  Vec2 sum(0, 0);
  double weights = 0;
  constexpr int kSteps = 60;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const Vec2 p((i + 0.5) / kSteps * 2 - 1, (j + 0.5) / kSteps * 2 - 1);
      if (p.norm() > 1) continue;
      const Vec3 point(centre_m.x() + radius_m * p.x(), centre_m.y() + radius_m * p.y(), height_m);
      const double weight = std::abs(camera.projection_jacobian(point)->leftCols<2>().determinant());
      sum += weight * *camera.pixel_of(point);
      weights += weight;
    }
  }
  return sum / weights;
}

struct ErrorStatistics {
  Vec2 sum{0, 0};
  double squares = 0, max_error = 0;
  int count = 0;
  void add(const Vec2& error) {
    sum += error;
    squares += error.squaredNorm();
    max_error = std::max(max_error, error.norm());
    ++count;
  }
};

void check(const ErrorStatistics& errors, double max_error_px) {
  INFO(fmt::format("mean {:.4f} {:.4f}, RMS {:.4f}, max {:.4f} px over {} dots",
                   errors.sum.x() / errors.count, errors.sum.y() / errors.count,
                   std::sqrt(errors.squares / errors.count), errors.max_error, errors.count));
  CHECK((errors.sum / errors.count).norm() < 0.002);
  CHECK(errors.max_error < max_error_px);
}

/// The second pattern lacks its front left dot.
MarkerLayout layout_with_missing_dot() {
  MarkerLayout layout = butterfly();
  layout.patterns[1].colours = layout.patterns[0].colours;
  layout.patterns[1].colours[0] = Colour::kBlack;
  return layout;
}

ErrorStatistics dot_errors(const OverheadCamera& overhead_camera, int count, Rng& rng) {
  const MarkerLayout layout = layout_with_missing_dot();
  const CameraModel camera = overhead_camera_model(overhead_camera);
  const RenderSpec spec = plain_spec();
  FrameRenderer renderer(camera, Field{12, 9}, layout, spec, Rng(1));
  ErrorStatistics errors;
  for (int i = 0; i < count; ++i) {
    SceneRobot robot = random_robot(inflated(overhead_camera.view_m, -0.15), rng);
    robot.pattern = 0;
    Image with = renderer.render(Scene{{&robot, 1}});
    robot.pattern = 1;
    Image without = renderer.render(Scene{{&robot, 1}});
    const Vec2 dot_m = robot.position_m + rotated(layout.dots[0].position_m, robot.heading_rad);
    const Vec2 exact = centroid_of_disc(camera, dot_m, spec.robot.height_m, layout.dots[0].radius_m);
    errors.add(centroid_of_difference(rgb_of(with), rgb_of(without), 0) - exact);
  }
  return errors;
}

TEST_CASE("a rendered dot lies where the camera projects it") {
  const std::uint64_t seed = 41;
  CAPTURE(seed);
  Rng rng(seed);
  check(dot_errors(quarter_field(), 300, rng), 0.02);
}

TEST_CASE("a rendered dot lies where a tilted camera projects it") {
  const std::uint64_t seed = 42;
  CAPTURE(seed);
  Rng rng(seed);
  OverheadCamera overhead_camera = quarter_field();
  overhead_camera.lateral_offset_m = Vec2(-1.5, 1);
  // At the far side, a dot's radius is 1.5 pixels, so rounding to whole levels has a larger effect.
  check(dot_errors(overhead_camera, 200, rng), 0.035);
}

TEST_CASE("a rendered ball lies where its viewing rays hit it") {
  const std::uint64_t seed = 43;
  CAPTURE(seed);
  Rng rng(seed);
  const CameraModel camera = overhead_camera_model(quarter_field());
  FrameRenderer renderer(camera, Field{12, 9}, butterfly(), plain_spec(), Rng(1));
  Image empty = renderer.render(Scene{});
  ErrorStatistics errors;
  for (int i = 0; i < 200; ++i) {
    const double z_m = rng.uniform(0.0215, 0.5), y_m = rng.uniform(-2, 2), x_m = rng.uniform(-2.8, 2.8);
    const SceneBall ball{Vec3(x_m, y_m, z_m)};
    // Lines below the ball would distort the weights, so balls near lines are skipped.
    const bool is_on_line = std::abs(ball.position_m.x()) < 0.4 || std::abs(ball.position_m.y()) < 0.4 ||
                            std::abs(ball.position_m.head<2>().norm() - 0.5) < 0.3;
    const auto middle = camera.pixel_of(ball.position_m);
    if (is_on_line || !camera.is_in_image(*middle + Vec2(8, 8)) || !camera.is_in_image(*middle - Vec2(8, 8)))
      continue;
    Image frame = renderer.render(Scene{{}, {}, ball});
    Vec2 sum(0, 0);
    int hits = 0;
    for (double y = middle->y() - 6; y < middle->y() + 6; y += 0.05) {
      for (double x = middle->x() - 6; x < middle->x() + 6; x += 0.05) {
        const Vec2 far = *camera.point_at(Vec2(x, y), 0);
        const Vec3 ray = (Vec3(far.x(), far.y(), 0) - camera.position_m()).normalized();
        if ((ball.position_m - camera.position_m()).cross(ray).norm() > kBallRadius_m) continue;
        sum += Vec2(x, y);
        ++hits;
      }
    }
    errors.add(centroid_of_difference(rgb_of(frame), rgb_of(empty), 0) - sum / hits);
  }
  CHECK(errors.count > 60);
  check(errors, 0.02);
}

}  // namespace sidestep::dot_centroid_test
