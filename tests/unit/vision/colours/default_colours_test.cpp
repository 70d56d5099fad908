// SPDX-License-Identifier: Apache-2.0
#include "vision/colours/default_colours.hpp"

#include "common/image/pixel_conversion.hpp"
#include "tests/catch.hpp"
#include "tests/unit/vision/detection/rendered_field.hpp"
#include "tests/unit/vision/detection/score.hpp"
#include "vision/colours/colour_learner.hpp"

namespace sidestep::default_colours_test {

using namespace sidestep::test;

const Time kBegin = time_from_ns(1'700'000'000'000'000'000);
constexpr Duration kFrame{16'666'667};

/// The class of a colour in light with this gain; nullopt if the colour has no class.
std::optional<std::uint32_t> classified_as(const ColourThresholds& thresholds, const Rgb& colour,
                                           const Eigen::Vector3d& gain) {
  Image pair(PixelFormat::kRgb, 2, 1);
  for (int i = 0; i < 6; i += 3) {
    pair.pixels()[i] = to_byte(gain.x() * colour.r);
    pair.pixels()[i + 1] = to_byte(gain.y() * colour.g);
    pair.pixels()[i + 2] = to_byte(gain.z() * colour.b);
  }
  const Image image = converted_to(thresholds.format, pair.view());
  return ColourClasses(thresholds.boxes).colour_of(pixel_at(image.view(), 0, 0));
}

constexpr std::array kMarkerAndBallColours{Colour::kOrange, Colour::kYellow, Colour::kBlue, Colour::kGreen,
                                           Colour::kPink};

TEST_CASE("named colours are classified in bright and dim light, and the ground has no class") {
  const auto format = GENERATE(PixelFormat::kYuv422, PixelFormat::kRgb);
  const ColourThresholds thresholds = default_colours(format);
  CHECK(thresholds.format == format);
  for (double light = 0.55; light < 1.001; light += 0.01) {
    CAPTURE(format, light);
    for (const Colour colour : kMarkerAndBallColours)
      CHECK(classified_as(thresholds, named(colour).rgb, Eigen::Vector3d(1, 1, 1) * light) ==
            static_cast<std::uint32_t>(colour));
    for (const double drift : {-0.1, 0.0, 0.1}) {
      for (const Colour ground : {Colour::kField, Colour::kWhite, Colour::kBlack})
        CHECK_FALSE(
            classified_as(thresholds, named(ground).rgb, Eigen::Vector3d(1 + drift, 1, 1 - drift) * light));
    }
  }
}

TEST_CASE("a colour that only one layout uses is classified only with that layout") {
  MarkerLayout layout = butterfly();
  layout.blue_team = Colour::kPurple;
  const Eigen::Vector3d full(1, 1, 1);
  const Rgb purple = named(Colour::kPurple).rgb;
  CHECK(classified_as(default_colours(PixelFormat::kRgb, layout), purple, full) ==
        static_cast<std::uint32_t>(Colour::kPurple));
  CHECK(classified_as(default_colours(PixelFormat::kRgb), purple, full) !=
        static_cast<std::uint32_t>(Colour::kPurple));
}

TEST_CASE("robots are found and located with the default colours even in bad light") {
  const auto format = GENERATE(PixelFormat::kYuv422, PixelFormat::kRgb);
  const double far_light = GENERATE(0.85, 0.6), drift = GENERATE(0.0, 0.1, -0.1);
  CAPTURE(format, far_light, drift);
  RenderSpec spec;
  spec.format = format;
  spec.far_light = far_light;
  spec.colour_gain = {1 + drift, 1, 1 - drift};
  RenderedField floor(7, spec);
  DetectorSettings settings;
  settings.boxes = default_colours(format).boxes;
  settings.layout = butterfly();
  settings.roster = roster_of(floor.scattered_robots(11));
  Detector detector(floor.camera, settings);
  Score score;
  msg::DetectionFrame frame;
  int balls = 0;
  for (int i = 0; i < 20; ++i) {
    const std::vector<PlacedRobot> robots = floor.scattered_robots(11);
    const Vec2 ball = floor.free_position(robots);
    detector.detect(floor.frame(robots, ball).view(), kBegin + i * kFrame, {}, frame);
    score.add(robots, frame);
    balls += frame.ball_count() == 1 &&
             (Vec2(frame.balls()[0].x_m(), frame.balls()[0].y_m()) - ball).norm() < 0.01;
  }
  CHECK(score.share() > 0.995);
  CHECK(score.wrong == 0);
  CHECK(score.position_m() < 0.0015);
  CHECK(score.heading_rad() < 1.0 / 57.3);
  CHECK(balls >= 19);
}

}  // namespace sidestep::default_colours_test
