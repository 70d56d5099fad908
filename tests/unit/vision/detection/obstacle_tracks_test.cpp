// SPDX-License-Identifier: Apache-2.0
#include "common/camera/camera_grid.hpp"
#include "common/marking/butterfly.hpp"
#include "simulator/rendering/frame_renderer.hpp"
#include "tests/catch.hpp"
#include "vision/colours/default_colours.hpp"
#include "vision/detection/detector.hpp"
#include "vision/tracking/tracker.hpp"

namespace sidestep::obstacle_tracks_test {

const Time kBegin = time_from_ns(1'700'000'000'000'000'000);
constexpr Duration kFrameInterval{8'333'333};

/// Two cameras with overlapping views, and a tracker for their detections.
struct TwoCameraFixture {
  Scenario scenario;
  std::vector<CameraModel> cameras;
  std::vector<FrameRenderer> renderers;
  std::vector<Detector> detectors;
  Tracker tracker;
  msg::DetectionFrame detections;
  Frame frame;

  TwoCameraFixture()
      : scenario(two_camera_scenario()),
        cameras(camera_grid(scenario)),
        tracker(tracker_settings(scenario), {}) {
    DetectorSettings settings;
    settings.boxes = default_colours(PixelFormat::kYuv422).boxes;
    settings.layout = butterfly();
    for (const CameraModel& camera : cameras) {
      renderers.emplace_back(camera, scenario.field, butterfly(), RenderSpec{}, Rng(renderers.size() + 1));
      detectors.emplace_back(camera, settings);
    }
  }
  static Scenario two_camera_scenario() {
    Scenario scenario;
    scenario.field = {9, 6};
    scenario.vision.images = ImageSpec{};
    return scenario;
  }
  /// The tracked obstacles after frame i, in which one obstacle is visible.
  std::vector<msg::TrackedObstacle> obstacles_after(int i, const Circle& obstacle) {
    const std::array cylinders{SceneCylinder{obstacle}};
    const Time at = kBegin + i * kFrameInterval;
    const auto camera = static_cast<std::size_t>(i % 2);
    detectors[camera].detect(renderers[camera].render(Scene{{}, cylinders}).view(), at, {}, detections);
    detections.camera(static_cast<std::uint32_t>(camera));
    frame.assign(detections, at);
    tracker.update(frame);
    msg::WorldState world;
    tracker.world_at(at, world);
    msg::ObstacleList list;
    tracker.obstacles_at(world, list);
    return list.obstacles();
  }
};

TEST_CASE("an obstacle in the view of two cameras is one stationary track") {
  TwoCameraFixture fixture;
  for (const double y_m : {-2.0, -0.5, 1.3}) {
    CAPTURE(y_m);
    const Circle obstacle{{0.1, y_m}, 0.12};
    std::vector<msg::TrackedObstacle> tracks;
    for (int i = 0; i < 60; ++i) tracks = fixture.obstacles_after(i, obstacle);
    REQUIRE(tracks.size() == 1);
    const msg::TrackedObstacle& track = tracks[0];
    CHECK((Vec2(track.x_m(), track.y_m()) - obstacle.centre_m).norm() < 0.02);
    CHECK(std::hypot(track.vx_mps(), track.vy_mps()) < 0.2);
    CHECK(track.radius_m() > 0.11);
    CHECK(track.radius_m() < 0.15);
    fixture.tracker = Tracker(tracker_settings(fixture.scenario), {});
  }
}

TEST_CASE("an obstacle that crosses from one camera's view to the other's keeps its track") {
  TwoCameraFixture fixture;
  std::uint32_t number = 0;
  for (int i = 0; i < 240; ++i) {
    const Circle obstacle{{-1 + 1.0 * to_seconds(i * kFrameInterval), 0.8}, 0.12};
    const std::vector<msg::TrackedObstacle> tracks = fixture.obstacles_after(i, obstacle);
    if (i < 20) continue;
    CAPTURE(i);
    REQUIRE(tracks.size() == 1);
    const msg::TrackedObstacle& track = tracks[0];
    if (number == 0) number = track.obstacle();
    CHECK(track.obstacle() == number);
    CHECK((Vec2(track.x_m(), track.y_m()) - obstacle.centre_m).norm() < 0.04);
    CHECK(std::abs(track.vx_mps() - 1) < 0.3);
    CHECK(std::abs(track.vy_mps()) < 0.3);
  }
}

}  // namespace sidestep::obstacle_tracks_test
