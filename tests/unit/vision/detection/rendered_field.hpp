// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/camera/overhead_camera.hpp"
#include "common/marking/butterfly.hpp"
#include "simulator/rendering/frame_renderer.hpp"
#include "tests/unit/vision/patterns/placed_robots.hpp"
#include "vision/colours/labelled_discs.hpp"
#include "vision/detection/detector.hpp"

namespace sidestep::test {

inline constexpr double kRobotHeight_m = 0.15, kBallRadius_m = 0.0215;

/// A camera over a quarter of a division-A field, and frames rendered for it.
class RenderedField {
 public:
  explicit RenderedField(std::uint64_t seed, const RenderSpec& spec = {}, const OverheadCamera& overhead = {})
      : camera(overhead_camera_model(overhead)),
        rng(seed),
        renderer_(camera, field(), butterfly(), spec, Rng(seed + 1)) {}

  /// Robots of both teams at random poses in the camera's view.
  std::vector<PlacedRobot> scattered_robots(std::size_t robots_per_team) {
    return scattered(butterfly(), robots_per_team, 0.2, rng);
  }
  /// A random position that no robot occludes.
  Vec2 free_position(const std::vector<PlacedRobot>& robots) {
    while (true) {
      const double y = rng.uniform(-2, 2), x = rng.uniform(-2.8, 2.8);
      const Vec2 position_m(x, y);
      const auto is_near = [&](const PlacedRobot& robot) {
        return (robot.pose.position_m - position_m).norm() < 0.3;
      };
      if (std::ranges::none_of(robots, is_near)) return position_m;
    }
  }

  /// Renders a frame with `hidden` randomly chosen dots of each robot covered.
  Image frame(const std::vector<PlacedRobot>& robots, const std::optional<Vec2>& ball_m = {}, int hidden = 0,
              std::span<const SceneCylinder> cylinders = {}) {
    std::vector<SceneRobot> scene_robots;
    for (const PlacedRobot& robot : robots) {
      SceneRobot one{robot.entry.team, robot.entry.pattern.id, robot.pose.position_m, robot.pose.heading_rad};
      while (std::popcount(one.hidden_dots) < hidden) one.hidden_dots |= 1U << rng.below(5);
      scene_robots.push_back(one);
    }
    Scene scene{scene_robots, cylinders};
    if (ball_m) scene.ball = SceneBall{{ball_m->x(), ball_m->y(), kBallRadius_m}, {0, 0}};
    return renderer_.render(scene);
  }

  /// Thresholds learned from a few frames with known poses.
  std::vector<ColourBox> learned_boxes() {
    ColourLearner learner;
    for (int i = 0; i < 3; ++i) {
      const std::vector<PlacedRobot> robots = scattered_robots(11);
      const Vec2 ball = free_position(robots);
      std::vector<LabelledDisc> discs;
      for (const PlacedRobot& robot : robots) {
        const auto dots = projected_dots(camera, butterfly(), robot.entry.team, robot.entry.pattern,
                                         robot.pose, kRobotHeight_m);
        discs.insert(discs.end(), dots.begin(), dots.end());
      }
      const Vec3 ball_m(ball.x(), ball.y(), kBallRadius_m);
      if (const auto disc = projected_disc(camera, Colour::kOrange, ball_m, kBallRadius_m))
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
