// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "tests/catch.hpp"
#include "tests/unit/vision/detection/rendered_field.hpp"
#include "vision/colours/default_colours.hpp"

namespace sidestep::obstacle_test {

using namespace sidestep::test;

const Time kBegin = time_from_ns(1'700'000'000'000'000'000);
constexpr Duration kFrame{16'666'667};

/// A rendered field, and a detector with the default colours.
struct ObstacleFixture {
  explicit ObstacleFixture(std::uint64_t seed, PixelFormat format = PixelFormat::kYuv422,
                           double far_light = 0.85, double drift = 0)
      : floor(seed, spec_of(format, far_light, drift)), detector(floor.camera, settings_of(format)) {}

  static RenderSpec spec_of(PixelFormat format, double far_light, double drift) {
    RenderSpec spec;
    spec.format = format;
    spec.far_light = far_light;
    spec.colour_gain = {1 + drift, 1, 1 - drift};
    return spec;
  }
  static DetectorSettings settings_of(PixelFormat format, std::vector<Shape> known = {}) {
    DetectorSettings settings;
    settings.known_obstacles = std::move(known);
    settings.boxes = default_colours(format).boxes;
    settings.layout = butterfly();
    Rng rng(1);
    settings.roster = roster_of(scattered(butterfly(), 11, 0.2, rng));
    return settings;
  }
  const msg::DetectionFrame& detect(const std::vector<PlacedRobot>& robots,
                                    std::span<const SceneCylinder> cylinders,
                                    const std::optional<Vec2>& ball = {}, bool are_expected = true) {
    const auto expected = are_expected ? expected_of(robots) : std::vector<ExpectedRobot>{};
    detector.detect(floor.frame(robots, ball, 0, cylinders).view(), kBegin + frames++ * kFrame, expected,
                    frame);
    return frame;
  }
  std::vector<Circle> obstacles() const {
    std::vector<Circle> found;
    for (std::size_t i = 0; i < frame.obstacle_count(); ++i)
      found.push_back(
          {{frame.obstacles()[i].x_m(), frame.obstacles()[i].y_m()}, frame.obstacles()[i].radius_m()});
    return found;
  }
  /// A random position where a disc of this radius is in view and touches no robot.
  Vec2 position_for(double radius_m, const std::vector<PlacedRobot>& robots) {
    const Vec2 limit(2.95 - radius_m, 2.15 - radius_m);
    while (true) {
      const double y = floor.rng.uniform(-limit.y(), limit.y());
      const double x = floor.rng.uniform(-limit.x(), limit.x());
      const Vec2 position_m(x, y);
      const auto is_near = [&](const PlacedRobot& robot) {
        return (robot.pose.position_m - position_m).norm() < radius_m + 0.3;
      };
      if (std::ranges::none_of(robots, is_near)) return position_m;
    }
  }

  RenderedField floor;
  Detector detector;
  msg::DetectionFrame frame;
  int frames = 0;
};

const std::array<Rgb, 5> kPaints{SceneCylinder{}.colour, named(Colour::kRed).rgb, named(Colour::kCyan).rgb,
                                 named(Colour::kPurple).rgb, Rgb{118, 44, 150}};

TEST_CASE("obstacles of colours that no robot or ball uses are found with their positions and radii") {
  const auto format = GENERATE(PixelFormat::kYuv422, PixelFormat::kRgb);
  const double height_m = GENERATE(0.002, 0.15, 0.3);
  ObstacleFixture fixture(11, format);
  for (const Rgb& colour : kPaints) {
    for (int i = 0; i < 12; ++i) {
      const std::vector<PlacedRobot> robots = fixture.floor.scattered_robots(6);
      const double radius_m = fixture.floor.rng.uniform(0.05, 0.3);
      const Vec2 position_m = fixture.position_for(radius_m, robots);
      const std::array cylinders{SceneCylinder{{position_m, radius_m}, height_m, colour}};
      fixture.detect(robots, cylinders);
      CAPTURE(format, height_m, int(colour.r), int(colour.g), int(colour.b), i, position_m.x(),
              position_m.y(), radius_m);
      const auto found = fixture.obstacles();
      REQUIRE(found.size() == 1);
      CAPTURE(found[0].centre_m.x(), found[0].centre_m.y(), found[0].radius_m);
      CHECK((found[0].centre_m - position_m).norm() < 0.02);
      CHECK(found[0].radius_m > radius_m - 0.01);
      CHECK(found[0].radius_m < radius_m + 0.03);
      CHECK(fixture.frame.robots().size() == robots.size());
      CHECK(fixture.frame.ball_count() == 0);
    }
  }
}

TEST_CASE("obstacles are located even in bad light") {
  const auto format = GENERATE(PixelFormat::kYuv422, PixelFormat::kRgb);
  const double drift = GENERATE(0.1, -0.1);
  ObstacleFixture fixture(12, format, 0.6, drift);
  for (const Rgb& colour : kPaints) {
    for (int i = 0; i < 12; ++i) {
      const double radius_m = fixture.floor.rng.uniform(0.06, 0.3);
      const Vec2 position_m = fixture.position_for(radius_m, {});
      const std::array cylinders{SceneCylinder{{position_m, radius_m}, 0.15, colour}};
      fixture.detect({}, cylinders);
      CAPTURE(format, drift, int(colour.r), int(colour.g), int(colour.b), i, position_m.x(), position_m.y(),
              radius_m);
      const auto found = fixture.obstacles();
      REQUIRE(found.size() == 1);
      CAPTURE(found[0].centre_m.x(), found[0].centre_m.y(), found[0].radius_m);
      CHECK((found[0].centre_m - position_m).norm() < 0.03);
      CHECK(found[0].radius_m > radius_m - 0.01);
    }
  }
}

TEST_CASE("robots and a ball are not mistaken for obstacles") {
  const auto format = GENERATE(PixelFormat::kYuv422, PixelFormat::kRgb);
  ObstacleFixture fixture(13, format);
  int false_positives = 0;
  std::size_t found_count = 0;
  for (int i = 0; i < 250; ++i) {
    const std::vector<PlacedRobot> robots = fixture.floor.scattered_robots(11);
    fixture.detect(robots, {}, fixture.floor.free_position(robots), i % 2 == 0);
    false_positives += fixture.frame.obstacle_count();
    found_count += fixture.frame.robots().size();
  }
  CHECK(false_positives == 0);
  CHECK(found_count > 5490);
}

TEST_CASE("robots and lines are not mistaken for obstacles in bad light") {
  const double drift = GENERATE(0.1, -0.1);
  const auto format = GENERATE(PixelFormat::kYuv422, PixelFormat::kRgb);
  CAPTURE(drift, format);
  ObstacleFixture fixture(14, format, 0.6, drift);
  int false_positives = 0;
  for (int i = 0; i < 50; ++i) {
    const std::vector<PlacedRobot> robots = fixture.floor.scattered_robots(11);
    false_positives += fixture.detect(robots, {}, fixture.floor.free_position(robots)).obstacle_count();
  }
  CHECK(false_positives == 0);
}

TEST_CASE("a robot and an obstacle next to each other are both found") {
  ObstacleFixture fixture(15);
  for (int i = 0; i < 20; ++i) {
    CAPTURE(i);
    std::vector<PlacedRobot> robots = fixture.floor.scattered_robots(1);
    robots.resize(1);
    robots[0].pose.position_m = {fixture.floor.rng.uniform(-2, 2), fixture.floor.rng.uniform(-1.4, 1.4)};
    const Vec2 offset_m = rotated({0.2, 0}, fixture.floor.rng.uniform(-3, 3));
    const std::array cylinders{
        SceneCylinder{{robots[0].pose.position_m + offset_m, 0.1}, 0.15, named(Colour::kRed).rgb}};
    fixture.detect(robots, cylinders);
    CHECK(fixture.frame.robots().size() == 1);
    const auto found = fixture.obstacles();
    REQUIRE(found.size() == 1);
    // Where the robot hides the obstacle's foot, the obstacle appears displaced outward in proportion to its
    // height.
    CHECK((found[0].centre_m - cylinders[0].circle.centre_m).norm() < 0.12);
    CHECK(found[0].radius_m > 0.09);
    CHECK(found[0].radius_m < 0.13);
  }
}

TEST_CASE("a known obstacle is not reported when robots or the image border hide parts of it") {
  const double height_m = GENERATE(0.002, 0.15, 0.3);
  const double far_light = GENERATE(0.85, 0.6);
  ObstacleFixture fixture(18, PixelFormat::kYuv422, far_light);
  Detector& without_known = fixture.detector;
  Rng& rng = fixture.floor.rng;
  int found_count = 0, displaced = 0;
  for (int i = 0; i < 100; ++i) {
    const Circle obstacle{{rng.uniform(-3.2, 3.2), rng.uniform(-2.4, 2.4)}, rng.uniform(0.05, 0.2)};
    std::vector<PlacedRobot> robots = fixture.floor.scattered_robots(1);
    for (PlacedRobot& robot : robots) {
      const double distance_m = obstacle.radius_m + 0.09 + rng.uniform(0.005, 0.1);
      do robot.pose.position_m = obstacle.centre_m + rotated({distance_m, 0}, rng.uniform(-3.2, 3.2));
      while ((robots[0].pose.position_m - robots[1].pose.position_m).norm() < 0.185);
    }
    const std::array cylinders{SceneCylinder{obstacle, height_m}};
    const Image image = fixture.floor.frame(robots, {}, i % 3, cylinders);
    const auto expected = expected_of(robots);
    without_known.detect(image.view(), kBegin + i * kFrame, expected, fixture.frame);
    for (const Circle& found : fixture.obstacles()) {
      ++found_count;
      displaced += (found.centre_m - obstacle.centre_m).norm() > 0.05;
    }
    const Circle known{obstacle.centre_m + rotated({0.02, 0}, rng.uniform(-3, 3)), obstacle.radius_m};
    Detector detector(fixture.floor.camera, ObstacleFixture::settings_of(PixelFormat::kYuv422, {known}));
    detector.detect(image.view(), kBegin, expected, fixture.frame);
    CAPTURE(height_m, far_light, i, obstacle.centre_m.x(), obstacle.centre_m.y(), obstacle.radius_m);
    CHECK(fixture.obstacles().empty());
  }
  CHECK(found_count > 60);
  CHECK(displaced > 3);
}

TEST_CASE("a known obstacle of any height is not reported") {
  ObstacleFixture fixture(20);
  for (int i = 0; i < 20; ++i) {
    const double radius_m = fixture.floor.rng.uniform(0.05, 0.2);
    const Circle known{fixture.position_for(radius_m + 0.3, {}), radius_m};
    Detector detector(fixture.floor.camera, ObstacleFixture::settings_of(PixelFormat::kYuv422, {known}));
    const std::array cylinders{SceneCylinder{known, 0.8}};
    detector.detect(fixture.floor.frame({}, {}, 0, cylinders).view(), kBegin, {}, fixture.frame);
    CAPTURE(i, known.centre_m.x(), known.centre_m.y(), radius_m);
    CHECK(fixture.obstacles().empty());
  }
}

TEST_CASE("an obstacle whose foot is hidden by a robot does not appear nearer") {
  ObstacleFixture fixture(21);
  Rng& rng = fixture.floor.rng;
  const Vec2 below_camera_m = fixture.floor.camera.position_m().head<2>();
  int found_count = 0;
  for (int i = 0; i < 100; ++i) {
    std::vector<PlacedRobot> robots = fixture.floor.scattered_robots(1);
    robots.resize(1);
    const Vec2 outward = rotated({1, 0}, rng.uniform(-3.2, 3.2));
    robots[0].pose.position_m = below_camera_m + rng.uniform(0.8, 1.8) * outward;
    const Circle obstacle{robots[0].pose.position_m + rotated(0.22 * outward, rng.uniform(-0.6, 0.6)), 0.12};
    const std::array cylinders{SceneCylinder{obstacle}};
    fixture.detect(robots, cylinders);
    CAPTURE(i, obstacle.centre_m.x(), obstacle.centre_m.y());
    for (const Circle& found : fixture.obstacles()) {
      ++found_count;
      CAPTURE(found.centre_m.x(), found.centre_m.y(), found.radius_m);
      CHECK((found.centre_m - below_camera_m).norm() - found.radius_m >
            (obstacle.centre_m - below_camera_m).norm() - obstacle.radius_m - 0.03);
    }
  }
  CHECK(found_count > 90);
}

TEST_CASE("an unknown obstacle beside or behind a known one is reported") {
  ObstacleFixture fixture(19);
  Rng& rng = fixture.floor.rng;
  const Vec2 below_camera_m = fixture.floor.camera.position_m().head<2>();
  for (int i = 0; i < 60; ++i) {
    Circle known{{rng.uniform(-1.5, 1.5), rng.uniform(-1, 1)}, 0.12};
    if (i == 0) known.centre_m = below_camera_m;
    // An unknown obstacle behind the known one must not touch it in the image, or else it may be hidden.
    const bool is_behind = i % 2 == 0;
    const double distance_m = known.radius_m + 0.1 + (is_behind ? 0.15 : 0) + rng.uniform(0, 0.2);
    const Vec2 outward =
        known.centre_m == below_camera_m ? Vec2(1, 0) : Vec2((known.centre_m - below_camera_m).normalized());
    double bearing_rad = 0;
    if (!is_behind) {
      const double side = rng.uniform(-1, 1);
      bearing_rad = std::copysign(rng.uniform(0.8, 3.14), side);
    }
    const Vec2 direction = rotated(outward, bearing_rad);
    const Circle other{known.centre_m + distance_m * direction, 0.1};
    Detector detector(fixture.floor.camera, ObstacleFixture::settings_of(PixelFormat::kYuv422, {known}));
    const std::array cylinders{SceneCylinder{known, 0.15},
                               SceneCylinder{other, 0.15, named(Colour::kPurple).rgb}};
    detector.detect(fixture.floor.frame({}, {}, 0, cylinders).view(), kBegin, {}, fixture.frame);
    CAPTURE(i, known.centre_m.x(), known.centre_m.y(), other.centre_m.x(), other.centre_m.y());
    const auto found = fixture.obstacles();
    REQUIRE(found.size() == 1);
    // An unknown obstacle that touches the known obstacle in the image forms one blob with it.
    CHECK((found[0].centre_m - other.centre_m).norm() < found[0].radius_m);
  }
}

TEST_CASE("the obstacle finder reports an image with more blobs than it can handle") {
  ObstacleFixture fixture(21);
  const Image image = fixture.floor.frame({});
  const ColourClasses classes(default_colours(PixelFormat::kYuv422).boxes);
  ObstacleFinder finder(fixture.floor.camera, {});
  std::vector<Region> regions;
  for (int y = 50; y < 500; y += 10) {
    for (int x = 50; x < 700; x += 10) regions.push_back({0, 36, x + 2.5, y + 2.5, x, x + 5, y, y + 5});
  }
  for (const std::size_t count : {1024u, 1025u, 1024u}) {
    CAPTURE(count);
    finder.find(image.view(), classes, std::span(regions).first(count), {});
    CHECK(finder.has_overflowed() == (count > 1024));
  }
}

TEST_CASE("several obstacles are separated, and the largest comes first") {
  ObstacleFixture fixture(16);
  const std::array cylinders{SceneCylinder{{{1, 1}, 0.1}, 0.15, named(Colour::kCyan).rgb},
                             SceneCylinder{{{1.5, 1}, 0.15}, 0.15, named(Colour::kRed).rgb},
                             SceneCylinder{{{-1, -1}, 0.05}}};
  fixture.detect({}, cylinders);
  const auto found = fixture.obstacles();
  REQUIRE(found.size() == 3);
  CHECK((found[0].centre_m - Vec2(1.5, 1)).norm() < 0.02);
  CHECK((found[1].centre_m - Vec2(1, 1)).norm() < 0.02);
  CHECK((found[2].centre_m - Vec2(-1, -1)).norm() < 0.02);
}

TEST_CASE("a ball next to an obstacle is found") {
  ObstacleFixture fixture(17);
  const std::array cylinders{SceneCylinder{{{0.5, 0.4}, 0.12}, 0.15, named(Colour::kRed).rgb}};
  fixture.detect({}, cylinders, Vec2(0.3, 0.3));
  REQUIRE(fixture.frame.ball_count() == 1);
  CHECK((Vec2(fixture.frame.balls()[0].x_m(), fixture.frame.balls()[0].y_m()) - Vec2(0.3, 0.3)).norm() <
        0.01);
  CHECK(fixture.obstacles().size() == 1);
}

}  // namespace sidestep::obstacle_test
