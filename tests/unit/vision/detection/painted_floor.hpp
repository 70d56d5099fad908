// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/camera/overhead_camera.hpp"
#include "common/marking/butterfly.hpp"
#include "simulator/rendering/frame_renderer.hpp"
#include "tests/unit/vision/patterns/scene.hpp"
#include "vision/colours/known_discs.hpp"
#include "vision/detection/detector.hpp"

namespace sidestep::test {

inline constexpr double kTop_m = 0.15, kBall_m = 0.0215;

/// A camera over a quarter of a division-A field, and what its frames show.
class PaintedFloor {
 public:
  explicit PaintedFloor(std::uint64_t seed, const RenderSpec& spec = {}, const OverheadCamera& how = {})
      : camera(hang(how)), rng(seed), renderer_(camera, field(), butterfly(), spec, Rng(seed + 1)) {}

  /// Robots of both teams, a ball, somewhere in the camera's view.
  std::vector<Marked> scattered_robots(std::size_t each) { return scattered(butterfly(), each, 0.2, rng); }
  /// Where no robot hides what lies there.
  Vec2 free_place(const std::vector<Marked>& robots) {
    while (true) {
      const Vec2 place(rng.uniform(-2.8, 2.8), rng.uniform(-2, 2));
      const auto is_near = [&](const Marked& robot) { return (robot.pose.position_m - place).norm() < 0.3; };
      if (std::ranges::none_of(robots, is_near)) return place;
    }
  }

  /// With so many dots of each robot covered, drawn.
  Image frame(const std::vector<Marked>& robots, const std::optional<Vec2>& ball_m = {}, int hidden = 0,
              std::span<const SceneBlob> blobs = {}) {
    std::vector<SceneRobot> seen;
    for (const Marked& robot : robots) {
      SceneRobot one{robot.entry.team, robot.entry.pattern.id, robot.pose.position_m, robot.pose.heading_rad};
      while (std::popcount(one.hidden_dots) < hidden) one.hidden_dots |= 1U << rng.below(5);
      seen.push_back(one);
    }
    Scene scene{seen, blobs};
    if (ball_m) scene.ball = SceneBall{{ball_m->x(), ball_m->y(), kBall_m}, {0, 0}};
    return renderer_.render(scene);
  }

  /// Learned from some frames with known poses.
  std::vector<ColourBox> learned_boxes() {
    ColourLearner learner;
    for (int i = 0; i < 3; ++i) {
      const std::vector<Marked> robots = scattered_robots(11);
      const Vec2 ball = free_place(robots);
      std::vector<KnownDisc> discs;
      for (const Marked& robot : robots) {
        const auto dots =
            seen_dots(camera, butterfly(), robot.entry.team, robot.entry.pattern, robot.pose, kTop_m);
        discs.insert(discs.end(), dots.begin(), dots.end());
      }
      if (const auto disc = seen_disc(camera, Colour::kOrange, {ball.x(), ball.y(), kBall_m}, kBall_m))
        discs.push_back(*disc);
      learner.add(frame(robots, ball).view(), discs);
    }
    return learner.boxes();
  }

  static Field field() {
    Field division_a;
    division_a.length_m = 12;
    division_a.width_m = 9;
    return division_a;
  }

  CameraModel camera;
  Rng rng;

 private:
  FrameRenderer renderer_;
};

}  // namespace sidestep::test
