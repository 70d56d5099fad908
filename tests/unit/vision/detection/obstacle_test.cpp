// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <catch2/catch.hpp>

#include "tests/unit/vision/detection/painted_floor.hpp"
#include "vision/colours/default_colours.hpp"

using namespace sidestep;
using namespace sidestep::test;

namespace {

const Time kBegin = time_from_ns(1'700'000'000'000'000'000);
constexpr Duration kFrame{16'666'667};

/// A floor, and somebody who reads its frames by the default colours.
struct Watched {
  explicit Watched(std::uint64_t seed, PixelFormat format = PixelFormat::kYuv422, double far_light = 0.85,
                   double drift = 0)
      : floor(seed, spec_of(format, far_light, drift)), reader(floor.camera, task_of(format)) {}

  static RenderSpec spec_of(PixelFormat format, double far_light, double drift) {
    RenderSpec spec;
    spec.format = format;
    spec.far_light = far_light;
    spec.colour_gain = {1 + drift, 1, 1 - drift};
    return spec;
  }
  static FrameTask task_of(PixelFormat format, std::vector<Circle> known = {}) {
    FrameTask task;
    task.known_obstacles = std::move(known);
    task.boxes = default_colours(format).boxes;
    task.layout = butterfly();
    Rng rng(1);
    task.roster = roster_of(scattered(butterfly(), 11, 0.2, rng));
    return task;
  }
  const msg::DetectionFrame& read(const std::vector<Marked>& robots, std::span<const SceneBlob> blobs,
                                  const std::optional<Vec2>& ball = {}, bool are_expected = true) {
    const auto expected = are_expected ? expected_of(robots) : std::vector<ExpectedRobot>{};
    reader.read(floor.frame(robots, ball, 0, blobs).view(), kBegin + frames++ * kFrame, expected, frame);
    return frame;
  }
  std::vector<Circle> obstacles() const {
    std::vector<Circle> found;
    for (std::size_t i = 0; i < frame.obstacle_count(); ++i)
      found.push_back(
          {{frame.obstacles()[i].x_m(), frame.obstacles()[i].y_m()}, frame.obstacles()[i].radius_m()});
    return found;
  }
  /// Where a disc of this size is in view and touches no robot.
  Vec2 place_for(double radius_m, const std::vector<Marked>& robots) {
    const Vec2 room(2.95 - radius_m, 2.15 - radius_m);
    while (true) {
      const Vec2 place(floor.rng.uniform(-room.x(), room.x()), floor.rng.uniform(-room.y(), room.y()));
      const auto is_near = [&](const Marked& robot) {
        return (robot.pose.position_m - place).norm() < radius_m + 0.3;
      };
      if (std::ranges::none_of(robots, is_near)) return place;
    }
  }

  PaintedFloor floor;
  Detector reader;
  msg::DetectionFrame frame;
  int frames = 0;
};

const std::array<Rgb, 5> kPaints{SceneBlob{}.colour, named(Colour::kRed).rgb, named(Colour::kCyan).rgb,
                                 named(Colour::kPurple).rgb, Rgb{118, 44, 150}};

}  // namespace

TEST_CASE("obstacles of colours that nobody named are found where they stand and as large as they are") {
  const auto format = GENERATE(PixelFormat::kYuv422, PixelFormat::kRgb);
  const double height_m = GENERATE(0.002, 0.15, 0.3);
  Watched watched(11, format);
  for (const Rgb& colour : kPaints) {
    for (int i = 0; i < 12; ++i) {
      const std::vector<Marked> robots = watched.floor.scattered_robots(6);
      const double radius_m = watched.floor.rng.uniform(0.05, 0.3);
      const Vec2 place = watched.place_for(radius_m, robots);
      const std::array blobs{SceneBlob{{place, radius_m}, height_m, colour}};
      watched.read(robots, blobs);
      CAPTURE(format, height_m, int(colour.r), int(colour.g), int(colour.b), i, place.x(), place.y(),
              radius_m);
      const auto found = watched.obstacles();
      REQUIRE(found.size() == 1);
      CAPTURE(found[0].centre_m.x(), found[0].centre_m.y(), found[0].radius_m);
      CHECK((found[0].centre_m - place).norm() < 0.02);
      CHECK(found[0].radius_m > radius_m - 0.01);
      CHECK(found[0].radius_m < radius_m + 0.03);
      CHECK(watched.frame.robots().size() == robots.size());
      CHECK(watched.frame.ball_count() == 0);
    }
  }
}

TEST_CASE("obstacles are found where they stand in bad light too") {
  const auto format = GENERATE(PixelFormat::kYuv422, PixelFormat::kRgb);
  const double drift = GENERATE(0.1, -0.1);
  Watched watched(12, format, 0.6, drift);
  for (const Rgb& colour : kPaints) {
    for (int i = 0; i < 12; ++i) {
      const double radius_m = watched.floor.rng.uniform(0.06, 0.3);
      const Vec2 place = watched.place_for(radius_m, {});
      const std::array blobs{SceneBlob{{place, radius_m}, 0.15, colour}};
      watched.read({}, blobs);
      CAPTURE(format, drift, int(colour.r), int(colour.g), int(colour.b), i, place.x(), place.y(), radius_m);
      const auto found = watched.obstacles();
      REQUIRE(found.size() == 1);
      CAPTURE(found[0].centre_m.x(), found[0].centre_m.y(), found[0].radius_m);
      CHECK((found[0].centre_m - place).norm() < 0.03);
      CHECK(found[0].radius_m > radius_m - 0.01);
    }
  }
}

TEST_CASE("robots and a ball are no obstacles") {
  const auto format = GENERATE(PixelFormat::kYuv422, PixelFormat::kRgb);
  Watched watched(13, format);
  int others = 0;
  std::size_t seen = 0;
  for (int i = 0; i < 250; ++i) {
    const std::vector<Marked> robots = watched.floor.scattered_robots(11);
    watched.read(robots, {}, watched.floor.free_place(robots), i % 2 == 0);
    others += watched.frame.obstacle_count();
    seen += watched.frame.robots().size();
  }
  CHECK(others == 0);
  CHECK(seen > 5490);
}

TEST_CASE("robots and lines are no obstacles where light is bad") {
  const double drift = GENERATE(0.1, -0.1);
  const auto format = GENERATE(PixelFormat::kYuv422, PixelFormat::kRgb);
  CAPTURE(drift, format);
  Watched watched(14, format, 0.6, drift);
  int others = 0;
  for (int i = 0; i < 50; ++i) {
    const std::vector<Marked> robots = watched.floor.scattered_robots(11);
    others += watched.read(robots, {}, watched.floor.free_place(robots)).obstacle_count();
  }
  CHECK(others == 0);
}

TEST_CASE("a robot beside an obstacle is found and so is the obstacle") {
  Watched watched(15);
  for (int i = 0; i < 20; ++i) {
    CAPTURE(i);
    std::vector<Marked> robots = watched.floor.scattered_robots(1);
    robots.resize(1);
    robots[0].pose.position_m = {watched.floor.rng.uniform(-2, 2), watched.floor.rng.uniform(-1.4, 1.4)};
    const Vec2 beside = rotated({0.2, 0}, watched.floor.rng.uniform(-3, 3));
    const std::array blobs{
        SceneBlob{{robots[0].pose.position_m + beside, 0.1}, 0.15, named(Colour::kRed).rgb}};
    watched.read(robots, blobs);
    CHECK(watched.frame.robots().size() == 1);
    const auto found = watched.obstacles();
    REQUIRE(found.size() == 1);
    // Where the robot hides its foot it seems to stand as far behind as its top is high.
    CHECK((found[0].centre_m - blobs[0].circle.centre_m).norm() < 0.12);
    CHECK(found[0].radius_m > 0.09);
    CHECK(found[0].radius_m < 0.13);
  }
}

TEST_CASE("a known obstacle is not told whatever robots and the edge hide of it") {
  const double height_m = GENERATE(0.002, 0.15, 0.3);
  const double far_light = GENERATE(0.85, 0.6);
  Watched watched(18, PixelFormat::kYuv422, far_light);
  Detector& knows_nothing = watched.reader;
  Rng& rng = watched.floor.rng;
  int seen = 0, displaced = 0;
  for (int i = 0; i < 100; ++i) {
    const Circle stands{{rng.uniform(-3.2, 3.2), rng.uniform(-2.4, 2.4)}, rng.uniform(0.05, 0.2)};
    std::vector<Marked> robots = watched.floor.scattered_robots(1);
    for (Marked& robot : robots) {
      const double away_m = stands.radius_m + 0.09 + rng.uniform(0.005, 0.1);
      do robot.pose.position_m = stands.centre_m + rotated({away_m, 0}, rng.uniform(-3.2, 3.2));
      while ((robots[0].pose.position_m - robots[1].pose.position_m).norm() < 0.185);
    }
    const std::array blobs{SceneBlob{stands, height_m}};
    const Image image = watched.floor.frame(robots, {}, i % 3, blobs);
    const auto expected = expected_of(robots);
    knows_nothing.read(image.view(), kBegin + i * kFrame, expected, watched.frame);
    for (const Circle& found : watched.obstacles()) {
      ++seen;
      displaced += (found.centre_m - stands.centre_m).norm() > 0.05;
    }
    const Circle known{stands.centre_m + rotated({0.02, 0}, rng.uniform(-3, 3)), stands.radius_m};
    Detector reader(watched.floor.camera, Watched::task_of(PixelFormat::kYuv422, {known}));
    reader.read(image.view(), kBegin, expected, watched.frame);
    CAPTURE(height_m, far_light, i, stands.centre_m.x(), stands.centre_m.y(), stands.radius_m);
    CHECK(watched.obstacles().empty());
  }
  CHECK(seen > 60);
  CHECK(displaced > 3);
}

TEST_CASE("a known obstacle is not told however high it is") {
  Watched watched(20);
  for (int i = 0; i < 20; ++i) {
    const double radius_m = watched.floor.rng.uniform(0.05, 0.2);
    const Circle known{watched.place_for(radius_m + 0.3, {}), radius_m};
    Detector reader(watched.floor.camera, Watched::task_of(PixelFormat::kYuv422, {known}));
    const std::array blobs{SceneBlob{known, 0.8}};
    reader.read(watched.floor.frame({}, {}, 0, blobs).view(), kBegin, {}, watched.frame);
    CAPTURE(i, known.centre_m.x(), known.centre_m.y(), radius_m);
    CHECK(watched.obstacles().empty());
  }
}

TEST_CASE("an obstacle whose foot a robot hides does not seem to stand nearer") {
  Watched watched(21);
  Rng& rng = watched.floor.rng;
  const Vec2 foot_m = watched.floor.camera.position_m().head<2>();
  int seen = 0;
  for (int i = 0; i < 100; ++i) {
    std::vector<Marked> robots = watched.floor.scattered_robots(1);
    robots.resize(1);
    const Vec2 outwards = rotated({1, 0}, rng.uniform(-3.2, 3.2));
    robots[0].pose.position_m = foot_m + rng.uniform(0.8, 1.8) * outwards;
    const Circle stands{robots[0].pose.position_m + rotated(0.22 * outwards, rng.uniform(-0.6, 0.6)), 0.12};
    const std::array blobs{SceneBlob{stands}};
    watched.read(robots, blobs);
    CAPTURE(i, stands.centre_m.x(), stands.centre_m.y());
    for (const Circle& found : watched.obstacles()) {
      ++seen;
      CAPTURE(found.centre_m.x(), found.centre_m.y(), found.radius_m);
      CHECK((found.centre_m - foot_m).norm() - found.radius_m >
            (stands.centre_m - foot_m).norm() - stands.radius_m - 0.03);
    }
  }
  CHECK(seen > 90);
}

TEST_CASE("something else beside or behind a known obstacle is told") {
  Watched watched(19);
  Rng& rng = watched.floor.rng;
  const Vec2 foot_m = watched.floor.camera.position_m().head<2>();
  for (int i = 0; i < 60; ++i) {
    Circle known{{rng.uniform(-1.5, 1.5), rng.uniform(-1, 1)}, 0.12};
    if (i == 0) known.centre_m = foot_m;
    // What is behind, and touches it as it is seen, is narrower than it and so is hidden.
    const bool is_behind = i % 2 == 0;
    const double away_m = known.radius_m + 0.1 + (is_behind ? 0.15 : 0) + rng.uniform(0, 0.2);
    const Vec2 outwards =
        known.centre_m == foot_m ? Vec2(1, 0) : Vec2((known.centre_m - foot_m).normalized());
    const double aside_rad = is_behind ? 0 : std::copysign(rng.uniform(0.8, 3.14), rng.uniform(-1, 1));
    const Vec2 direction = rotated(outwards, aside_rad);
    const Circle other{known.centre_m + away_m * direction, 0.1};
    Detector reader(watched.floor.camera, Watched::task_of(PixelFormat::kYuv422, {known}));
    const std::array blobs{SceneBlob{known, 0.15}, SceneBlob{other, 0.15, named(Colour::kPurple).rgb}};
    reader.read(watched.floor.frame({}, {}, 0, blobs).view(), kBegin, {}, watched.frame);
    CAPTURE(i, known.centre_m.x(), known.centre_m.y(), other.centre_m.x(), other.centre_m.y());
    const auto found = watched.obstacles();
    REQUIRE(found.size() == 1);
    // What touches the known one makes one thing with it.
    CHECK((found[0].centre_m - other.centre_m).norm() < found[0].radius_m);
  }
}

TEST_CASE("several obstacles are told apart and the largest comes first") {
  Watched watched(16);
  const std::array blobs{SceneBlob{{{1, 1}, 0.1}, 0.15, named(Colour::kCyan).rgb},
                         SceneBlob{{{1.5, 1}, 0.15}, 0.15, named(Colour::kRed).rgb},
                         SceneBlob{{{-1, -1}, 0.05}}};
  watched.read({}, blobs);
  const auto found = watched.obstacles();
  REQUIRE(found.size() == 3);
  CHECK((found[0].centre_m - Vec2(1.5, 1)).norm() < 0.02);
  CHECK((found[1].centre_m - Vec2(1, 1)).norm() < 0.02);
  CHECK((found[2].centre_m - Vec2(-1, -1)).norm() < 0.02);
}

TEST_CASE("a ball beside an obstacle is a ball") {
  Watched watched(17);
  const std::array blobs{SceneBlob{{{0.5, 0.4}, 0.12}, 0.15, named(Colour::kRed).rgb}};
  watched.read({}, blobs, Vec2(0.3, 0.3));
  REQUIRE(watched.frame.ball_count() == 1);
  CHECK((Vec2(watched.frame.balls()[0].x_m(), watched.frame.balls()[0].y_m()) - Vec2(0.3, 0.3)).norm() <
        0.01);
  CHECK(watched.obstacles().size() == 1);
}
