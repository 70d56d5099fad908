// SPDX-License-Identifier: Apache-2.0
#include "simulator/rendering/frame_renderer.hpp"

#include <cmath>
#include <cstring>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <vector>

#include "common/marking/butterfly.hpp"
#include "tests/catch.hpp"
#include "tests/unit/simulator/rendering/plain_spec.hpp"

namespace sidestep::frame_renderer_test {

const Field kField{12, 9};

struct RandomScene {
  std::vector<SceneRobot> robots;
  std::vector<SceneCylinder> cylinders;
  SceneBall ball;
  Scene scene() const { return {robots, cylinders, ball}; }
};

/// A random scene in which some objects overlap or are outside the image.
RandomScene random_scene(Rng& rng) {
  RandomScene objects;
  const Box view_m = inflated(quarter_field().view_m, 0.4);
  for (int i = 0; i < 12; ++i) objects.robots.push_back(random_robot(view_m, rng));
  objects.robots[1].position_m = objects.robots[0].position_m + Vec2(0.18, 0.02);
  for (int i = 0; i < 3; ++i)
    objects.cylinders.push_back(
        {{random_robot(view_m, rng).position_m, rng.uniform(0.05, 0.3)}, rng.uniform(0.05, 0.4)});
  const double y = rng.uniform(-2, 2), x = rng.uniform(-2, 2);
  objects.ball.position_m = Vec3(x, y, 0.0215);
  return objects;
}

bool are_equal(const Image& a, const Image& b) {
  return a.view().bytes() == b.view().bytes() &&
         std::memcmp(a.view().pixels, b.view().pixels, a.view().bytes()) == 0;
}

FrameRenderer renderer_with(const RenderSpec& spec, std::uint64_t seed = 1) {
  return FrameRenderer(overhead_camera_model(quarter_field()), kField, butterfly(), spec, Rng(seed));
}

TEST_CASE("the same seed gives the same frames, and another seed gives different ones") {
  Rng rng(71);
  const RandomScene objects = random_scene(rng);
  for (const PixelFormat format : {PixelFormat::kRgb, PixelFormat::kYuv422}) {
    RenderSpec spec;
    spec.format = format;
    FrameRenderer a = renderer_with(spec, 5), b = renderer_with(spec, 5), c = renderer_with(spec, 6);
    const Image first = a.render(objects.scene());
    CHECK(are_equal(first, b.render(objects.scene())));
    CHECK(!are_equal(first, c.render(objects.scene())));
    const Image second = a.render(objects.scene());
    CHECK(!are_equal(first, second));
    CHECK(are_equal(second, b.render(objects.scene())));
  }
}

TEST_CASE("a frame shows no traces of earlier objects") {
  const std::uint64_t seed = 72;
  CAPTURE(seed);
  Rng rng(seed);
  RenderSpec spec;
  spec.noise = 0;
  spec.exposure_s = 0.005;
  FrameRenderer renderer = renderer_with(spec);
  const Image empty = renderer.render(Scene{});
  for (int i = 0; i < 20; ++i) {
    const Image frame = renderer.render(random_scene(rng).scene());
    CHECK(!are_equal(frame, empty));
    CHECK(are_equal(renderer.render(Scene{}), empty));
  }
}

TEST_CASE("the lens blurs the whole image") {
  const std::uint64_t seed = 73;
  CAPTURE(seed);
  Rng rng(seed);
  RenderSpec spec = plain_spec();
  FrameRenderer sharp = renderer_with(spec);
  spec.blur_px = 0.8;
  FrameRenderer soft = renderer_with(spec);
  for (int i = 0; i < 10; ++i) {
    const RandomScene objects = random_scene(rng);
    Image frame = sharp.render(objects.scene());
    cv::Mat3b expected;
    cv::GaussianBlur(rgb_of(frame), expected, {5, 5}, 0.8, 0.8, cv::BORDER_REPLICATE);
    Image blurred = soft.render(objects.scene());
    CHECK(cv::norm(rgb_of(blurred), expected, cv::NORM_INF) == 0);
  }
}

TEST_CASE("a YUV frame shows the same as an RGB frame") {
  const std::uint64_t seed = 74;
  CAPTURE(seed);
  Rng rng(seed);
  RenderSpec spec = plain_spec();
  spec.blur_px = 0.7;
  spec.far_light = 0.7;
  FrameRenderer rgb = renderer_with(spec);
  spec.format = PixelFormat::kYuv422;
  FrameRenderer yuv = renderer_with(spec);
  const RandomScene objects = random_scene(rng);
  const Image a = rgb.render(objects.scene()), b = yuv.render(objects.scene());
  for (int y = 0; y < 580; ++y) {
    for (int x = 0; x < 780; x += 2) {
      const std::uint8_t* const p = a.view().row(y) + 3 * x;
      const std::uint8_t* const q = b.view().row(y) + 2 * x;
      const Rgb left{p[0], p[1], p[2]}, right{p[3], p[4], p[5]};
      REQUIRE(std::abs(q[1] - yuv_of(left).y) <= 1);
      REQUIRE(std::abs(q[3] - yuv_of(right).y) <= 1);
      REQUIRE(std::abs(2 * q[0] - yuv_of(left).u - yuv_of(right).u) <= 2);
      REQUIRE(std::abs(2 * q[2] - yuv_of(left).v - yuv_of(right).v) <= 2);
    }
  }
}

TEST_CASE("nearer objects hide farther ones") {
  FrameRenderer renderer = renderer_with(plain_spec());
  // The camera is above the origin, so a robot at x = 2 hides 80 mm of the floor behind it.
  const SceneRobot robot{Team::kBlue, 3, Vec2(2, 0), 3};
  const Image alone = renderer.render(Scene{{&robot, 1}});
  const Image hidden = renderer.render(Scene{{&robot, 1}, {}, SceneBall{Vec3(2.112, 0, 0.0215)}});
  CHECK(are_equal(alone, hidden));
  const Image seen = renderer.render(Scene{{&robot, 1}, {}, SceneBall{Vec3(1.88, 0, 0.0215)}});
  CHECK(!are_equal(alone, seen));
  // The order in the scene does not matter.
  const std::vector<SceneRobot> pair{robot, {Team::kYellow, 5, Vec2(2.185, 0), 1}};
  const std::vector<SceneRobot> reversed{pair[1], pair[0]};
  CHECK(are_equal(renderer.render(Scene{pair}), renderer.render(Scene{reversed})));
}

TEST_CASE("light and white balance affect all colours") {
  RenderSpec spec = plain_spec();
  spec.far_light = 0.5;
  FrameRenderer renderer = renderer_with(spec);
  const Vec2 place(2.5, 1);
  const SceneCylinder cylinder{{place, 0.2}, 0.01, Rgb{200, 100, 50}};
  const Vec2 pixel = *renderer.camera().pixel_of(Vec3(place.x(), place.y(), 0.01));
  const auto pixel_colour = [&](FrameRenderer& with, const Scene& scene) {
    Image frame = with.render(scene);
    return rgb_of(frame)(static_cast<int>(pixel.y()), static_cast<int>(pixel.x()));
  };
  const double light = 1 - 0.5 * (2.5 + 6) / 12;
  const cv::Vec3b plain = pixel_colour(renderer, Scene{{}, {&cylinder, 1}});
  CHECK(std::abs(plain[0] - 200 * light) < 1);
  CHECK(std::abs(plain[1] - 100 * light) < 1);
  const cv::Vec3b surface = pixel_colour(renderer, Scene{});
  CHECK(std::abs(surface[1] - 98 * light) < 1);
  spec.colour_gain = {1.1, 1, 0.9};
  FrameRenderer tinting = renderer_with(spec);
  const cv::Vec3b tinted = pixel_colour(tinting, Scene{{}, {&cylinder, 1}});
  CHECK(std::abs(tinted[0] - 220 * light) < 1);
  CHECK(std::abs(tinted[1] - 100 * light) < 1);
  CHECK(std::abs(tinted[2] - 45 * light) < 1);
  CHECK(std::abs(pixel_colour(tinting, Scene{})[0] - 1.1 * surface[0]) < 1);
}

TEST_CASE("a rendered robot shows the dots of its team and id, and hidden dots are black") {
  FrameRenderer renderer = renderer_with(plain_spec());
  const auto colour_at = [&](const SceneRobot& robot, const Vec2& in_robot) {
    Image frame = renderer.render(Scene{{&robot, 1}});
    const Vec2 p = robot.position_m + rotated(in_robot, robot.heading_rad);
    const Vec2 pixel = *renderer.camera().pixel_of(Vec3(p.x(), p.y(), 0.15));
    const cv::Vec3b c =
        rgb_of(frame)(static_cast<int>(std::lround(pixel.y())), static_cast<int>(std::lround(pixel.x())));
    return Rgb{c[0], c[1], c[2]};
  };
  for (const MarkerPattern& pattern : butterfly().patterns) {
    for (const Team team : {Team::kBlue, Team::kYellow}) {
      SceneRobot robot{team, pattern.id, Vec2(0.3 * pattern.id - 2.4, 0.8), 0.7 * pattern.id};
      CHECK(colour_at(robot, Vec2(0, 0)) == named(butterfly().team_colour(team)).rgb);
      for (std::size_t i = 0; i < 4; ++i) {
        CHECK(colour_at(robot, butterfly().dots[i].position_m) == named(pattern.colours[i]).rgb);
        robot.hidden_dots = 2U << i;
        CHECK(colour_at(robot, butterfly().dots[i].position_m) == named(Colour::kBlack).rgb);
        robot.hidden_dots = 0;
      }
    }
  }
  CHECK(colour_at(SceneRobot{Team::kBlue, 99, Vec2(1, 1), 0}, Vec2(0, 0)) == named(Colour::kBlack).rgb);
}

TEST_CASE("a YUV camera with an odd image width is refused") {
  OverheadCamera overhead_camera = quarter_field();
  overhead_camera.width_px = 781;
  RenderSpec spec;
  CHECK_THROWS_AS(FrameRenderer(overhead_camera_model(overhead_camera), kField, butterfly(), spec, Rng(1)),
                  std::invalid_argument);
  spec.format = PixelFormat::kRgb;
  CHECK_NOTHROW(FrameRenderer(overhead_camera_model(overhead_camera), kField, butterfly(), spec, Rng(1))
                    .render(Scene{}));
}

TEST_CASE("robots outside the camera's view are omitted") {
  RenderSpec spec = plain_spec();
  OverheadCamera overhead_camera = quarter_field();
  overhead_camera.lateral_offset_m =
      Vec2(-6, 0);  // strongly tilted, so that half of the world is behind the camera
  FrameRenderer renderer(overhead_camera_model(overhead_camera), kField, butterfly(), spec, Rng(1));
  const Image empty = renderer.render(Scene{});
  for (const Vec2& place : {Vec2(-60, 0), Vec2(1000, 0), Vec2(0, 1e6), Vec2(-1e9, 1e9)}) {
    const SceneRobot robot{Team::kBlue, 0, place, 0};
    CHECK(are_equal(renderer.render(Scene{{&robot, 1}}), empty));
  }
}

}  // namespace sidestep::frame_renderer_test
