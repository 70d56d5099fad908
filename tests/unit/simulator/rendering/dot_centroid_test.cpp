// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>

#include "common/marking/butterfly.hpp"
#include "simulator/rendering/round_ball.hpp"
#include "tests/unit/simulator/rendering/plain_spec.hpp"

using namespace sidestep;

namespace {

/// The centroid of what differs between two frames, weighted with how much.
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

/// The centroid of a disc's image: its points projected one by one, weighted with the image's area there.
Vec2 centroid_of_disc(const CameraModel& camera, const Vec2& centre_m, double height_m, double radius_m) {
  Vec2 sum(0, 0);
  double weights = 0;
  constexpr int kSteps = 60;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const Vec2 p((i + 0.5) / kSteps * 2 - 1, (j + 0.5) / kSteps * 2 - 1);
      if (p.norm() > 1) continue;
      const Vec3 point(centre_m.x() + radius_m * p.x(), centre_m.y() + radius_m * p.y(), height_m);
      const double weight = std::abs(camera.pixels_per_metre(point)->leftCols<2>().determinant());
      sum += weight * *camera.pixel_of(point);
      weights += weight;
    }
  }
  return sum / weights;
}

struct Bias {
  Vec2 sum{0, 0};
  double squares = 0, largest = 0;
  int count = 0;
  void add(const Vec2& error) {
    sum += error;
    squares += error.squaredNorm();
    largest = std::max(largest, error.norm());
    ++count;
  }
};

void check(const Bias& bias, double largest_px) {
  INFO(fmt::format("mean {:.4f} {:.4f}, RMS {:.4f}, largest {:.4f} px over {} dots",
                   bias.sum.x() / bias.count, bias.sum.y() / bias.count, std::sqrt(bias.squares / bias.count),
                   bias.largest, bias.count));
  CHECK((bias.sum / bias.count).norm() < 0.002);
  CHECK(bias.largest < largest_px);
}

/// The front left dot of the second pattern is missing.
MarkingLayout with_and_without() {
  MarkingLayout layout = butterfly();
  layout.patterns[1].colours = layout.patterns[0].colours;
  layout.patterns[1].colours[0] = Colour::kBlack;
  return layout;
}

Bias bias_of_dots(const OverheadCamera& hanging, int count, Rng& rng) {
  const MarkingLayout layout = with_and_without();
  const CameraModel camera = hang(hanging);
  const RenderSpec spec = plain_spec();
  FrameRenderer renderer(camera, Field{12, 9}, layout, spec, Rng(1));
  Bias bias;
  for (int i = 0; i < count; ++i) {
    SceneRobot robot = random_robot(grown(hanging.view_m, -0.15), rng);
    robot.pattern = 0;
    Image with = renderer.render(Scene{{&robot, 1}});
    robot.pattern = 1;
    Image without = renderer.render(Scene{{&robot, 1}});
    const Vec2 dot_m = robot.position_m + rotated(layout.dots[0].position_m, robot.heading_rad);
    const Vec2 exact = centroid_of_disc(camera, dot_m, spec.robot.height_m, layout.dots[0].radius_m);
    bias.add(centroid_of_difference(rgb_of(with), rgb_of(without), 0) - exact);
  }
  return bias;
}

}  // namespace

TEST_CASE("a rendered dot lies where the camera projects it") {
  const std::uint64_t seed = 41;
  CAPTURE(seed);
  Rng rng(seed);
  check(bias_of_dots(quarter_field(), 300, rng), 0.02);
}

TEST_CASE("a rendered dot lies where a tilted camera projects it") {
  const std::uint64_t seed = 42;
  CAPTURE(seed);
  Rng rng(seed);
  OverheadCamera hanging = quarter_field();
  hanging.aside_m = Vec2(-1.5, 1);
  // On the far side a dot has a radius of 1.5 pixels, and a whole level is a larger share of it.
  check(bias_of_dots(hanging, 200, rng), 0.035);
}

TEST_CASE("a rendered ball lies where the rays that meet it say") {
  const std::uint64_t seed = 43;
  CAPTURE(seed);
  Rng rng(seed);
  const CameraModel camera = hang(quarter_field());
  FrameRenderer renderer(camera, Field{12, 9}, butterfly(), plain_spec(), Rng(1));
  Image empty = renderer.render(Scene{});
  Bias bias;
  for (int i = 0; i < 200; ++i) {
    const SceneBall ball{Vec3(rng.uniform(-2.8, 2.8), rng.uniform(-2, 2), rng.uniform(0.0215, 0.5))};
    // Lines under the ball weigh differently: balls near them are left out.
    const bool is_on_line = std::abs(ball.position_m.x()) < 0.4 || std::abs(ball.position_m.y()) < 0.4 ||
                            std::abs(ball.position_m.head<2>().norm() - 0.5) < 0.3;
    const auto middle = camera.pixel_of(ball.position_m);
    if (is_on_line || !camera.shows(*middle + Vec2(8, 8)) || !camera.shows(*middle - Vec2(8, 8))) continue;
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
    bias.add(centroid_of_difference(rgb_of(frame), rgb_of(empty), 0) - sum / hits);
  }
  CHECK(bias.count > 60);
  check(bias, 0.02);
}
