// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "common/marking/butterfly.hpp"
#include "simulator/rendering/field_surface.hpp"
#include "tests/catch.hpp"
#include "tests/unit/simulator/rendering/plain_spec.hpp"

namespace sidestep::floor_test {

TEST_CASE("field lines lie where the league's rules place them") {
  const FieldLines a(Field{12, 9}), b(Field{9, 6});
  for (const Vec2& p : {Vec2(6, 1), Vec2(-6, -4.5), Vec2(3, 4.5), Vec2(0, 3), Vec2(2, 0), Vec2(0.5, 0),
                        Vec2(0, -0.5), Vec2(4.2, 1), Vec2(-5, 1.8), Vec2(4.2, -1.8)})
    CHECK(a.distance_m(p) == Approx(-0.005));
  for (const Vec2& p : {Vec2(4.5, 1), Vec2(0.3, 0.4), Vec2(3.5, 1), Vec2(-4, -1), Vec2(0, 2.9)})
    CHECK(b.distance_m(p) == Approx(-0.005));
  CHECK(a.distance_m(Vec2(6.1, 1)) == Approx(0.095));
  CHECK(a.distance_m(Vec2(3, 1)) == Approx(0.995));
  // The halfway line ends at the edge of the field.
  CHECK(a.distance_m(Vec2(0, 4.6)) == Approx(0.095));
}

TEST_CASE("light falls off to the specified fraction at the far end") {
  RenderSpec spec;
  spec.far_light = 0.6;
  const Field field{12, 9};
  CHECK(light_fraction_at(spec, field, Vec2(-6, 2)) == Approx(1));
  CHECK(light_fraction_at(spec, field, Vec2(0, -4)) == Approx(0.8));
  CHECK(light_fraction_at(spec, field, Vec2(6, 0)) == Approx(0.6));
  CHECK(light_fraction_at(spec, field, Vec2(9, 0)) == Approx(0.6));
  spec.light_falloff = LightFalloff::kRadial;
  CHECK(light_fraction_at(spec, field, Vec2(0, 0)) == Approx(1));
  CHECK(light_fraction_at(spec, field, Vec2(6, -4.5)) == Approx(0.6));
}

TEST_CASE("a white line in the image runs where the camera projects it") {
  const CameraModel camera = overhead_camera_model(quarter_field());
  FrameRenderer renderer(camera, Field{12, 9}, butterfly(), plain_spec(), Rng(1));
  Image frame = renderer.render(Scene{});
  const cv::Mat3b rgb = rgb_of(frame);
  int rows = 0;
  double sum = 0;
  for (int y = 20; y < 560; ++y) {
    // Follows the halfway line, x = 0, except where the centre circle and the centre line cross it.
    const Vec2 place = *camera.point_at(Vec2(389.5, y), 0);
    if (std::abs(place.y()) < 0.1 || std::abs(std::abs(place.y()) - 0.5) < 0.1) continue;
    const double expected = camera.pixel_of(Vec3(0, place.y(), 0))->x();
    double weights = 0, x_sum = 0;
    for (int x = 380; x < 400; ++x) {
      weights += rgb(y, x)[0] - 38.0;
      x_sum += (rgb(y, x)[0] - 38.0) * x;
    }
    REQUIRE(weights > 100);
    REQUIRE(std::abs(x_sum / weights - expected) < 0.02);
    sum += x_sum / weights - expected;
    ++rows;
  }
  CHECK(rows > 300);
  CHECK(std::abs(sum / rows) < 0.01);
}

}  // namespace sidestep::floor_test
