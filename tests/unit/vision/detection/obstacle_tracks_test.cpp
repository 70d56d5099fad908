// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "common/camera/camera_grid.hpp"
#include "common/marking/butterfly.hpp"
#include "simulator/rendering/frame_renderer.hpp"
#include "vision/colours/default_colours.hpp"
#include "vision/detection/detector.hpp"
#include "vision/tracking/tracker.hpp"

using namespace sidestep;

namespace {

const Time kBegin = time_from_ns(1'700'000'000'000'000'000);
constexpr Duration kBetween{8'333'333};

/// Two cameras whose views overlap, and a tracker of what they see.
struct Hall {
  Scenario scenario;
  std::vector<CameraModel> cameras;
  std::vector<FrameRenderer> renderers;
  std::vector<Detector> readers;
  Tracker tracker;
  msg::DetectionFrame detections;
  Frame frame;

  Hall() : scenario(made()), cameras(hang_grid(scenario)), tracker(tracker_settings(scenario), {}) {
    FrameTask task;
    task.boxes = default_colours(PixelFormat::kYuv422).boxes;
    task.layout = butterfly();
    for (const CameraModel& camera : cameras) {
      renderers.emplace_back(camera, scenario.field, butterfly(), RenderSpec{}, Rng(renderers.size() + 1));
      readers.emplace_back(camera, task);
    }
  }
  static Scenario made() {
    Scenario scenario;
    scenario.field = {9, 6};
    scenario.vision.images = ImageSpec{};
    return scenario;
  }
  /// What the world holds after frame i, in which one thing stood here.
  msg::WorldState see(int i, const Circle& thing) {
    const std::array blobs{SceneBlob{thing}};
    const Time at = kBegin + i * kBetween;
    const auto camera = static_cast<std::size_t>(i % 2);
    readers[camera].read(renderers[camera].render(Scene{{}, blobs}).view(), at, {}, detections);
    detections.camera(static_cast<std::uint32_t>(camera));
    frame.assign(detections, at);
    tracker.update(frame);
    msg::WorldState world;
    tracker.world_at(at, world);
    return world;
  }
};

}  // namespace

TEST_CASE("an obstacle that two cameras see is one and stands still") {
  Hall hall;
  for (const double y_m : {-2.0, -0.5, 1.3}) {
    CAPTURE(y_m);
    const Circle thing{{0.1, y_m}, 0.12};
    msg::WorldState world;
    for (int i = 0; i < 60; ++i) world = hall.see(i, thing);
    REQUIRE(world.obstacle_count() == 1);
    const msg::TrackedObstacle& seen = world.obstacles()[0];
    CHECK((Vec2(seen.x_m(), seen.y_m()) - thing.centre_m).norm() < 0.02);
    CHECK(std::hypot(seen.vx_mps(), seen.vy_mps()) < 0.2);
    CHECK(seen.radius_m() > 0.11);
    CHECK(seen.radius_m() < 0.15);
    hall.tracker = Tracker(tracker_settings(hall.scenario), {});
  }
}

TEST_CASE("an obstacle that crosses from one camera to the other stays one") {
  Hall hall;
  std::uint32_t number = 0;
  for (int i = 0; i < 240; ++i) {
    const Circle thing{{-1 + 1.0 * to_seconds(i * kBetween), 0.8}, 0.12};
    const msg::WorldState world = hall.see(i, thing);
    if (i < 20) continue;
    CAPTURE(i);
    REQUIRE(world.obstacle_count() == 1);
    const msg::TrackedObstacle& seen = world.obstacles()[0];
    if (number == 0) number = seen.obstacle();
    CHECK(seen.obstacle() == number);
    CHECK((Vec2(seen.x_m(), seen.y_m()) - thing.centre_m).norm() < 0.04);
    CHECK(std::abs(seen.vx_mps() - 1) < 0.3);
    CHECK(std::abs(seen.vy_mps()) < 0.3);
  }
}
