// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/random/rng.hpp"
#include "deploy/evaluation/study/vision/swaying_robots.hpp"
#include "simulator/rendering/frame_renderer.hpp"
#include "vision/images/image_reader.hpp"
#include "vision/tracking/tracker.hpp"

namespace sidestep {

/// The number of the robot that wears a pattern; number_of() gives the pattern back.
constexpr RobotId robot_wearing(Team team, std::uint32_t pattern) {
  return team == Team::kBlue ? pattern : 16 + pattern;
}

/// A field with cameras over it and all 32 robots of two teams on its roster.
Scenario hall_scenario(const Field& field, int columns, int rows);

/// Cameras over swaying robots, and vision behind them.
class Hall {
 public:
  Hall(const Scenario& scenario, const RenderSpec& spec, const ColourThresholds& colours, Rng& rng);

  /// Other robots, so many of each team, later; what was tracked is forgotten.
  void clear(std::size_t each);
  /// From now on so many dots of each robot are covered, drawn.
  void cover(int dots);
  /// The next frames of all cameras.
  void step();

  /// The truth when they were taken.
  const std::vector<SceneRobot>& robots() const { return robots_; }
  const SceneBall& ball() const { return ball_; }
  const CameraModel& camera(std::size_t number) const { return renderers_[number].camera(); }
  const std::vector<msg::CameraImage>& images() const { return images_; }
  const Detector& reader(std::size_t number) const { return reader_.camera(number); }
  /// Lets vision see the images, up to the world's state at their time.
  void see();
  const std::vector<msg::DetectionFrame>& detections() const { return detections_; }
  const msg::WorldState& world() const { return world_; }

 private:
  Rng rng_;
  Scenario scenario_;
  std::vector<FrameRenderer> renderers_;
  ImageReader reader_;
  std::optional<SwayingRobots> swaying_;
  std::optional<Tracker> tracker_;
  double time_s_ = 1000;
  std::vector<SceneRobot> robots_;
  SceneBall ball_;
  std::vector<msg::CameraImage> images_;
  std::vector<msg::DetectionFrame> detections_;
  Frame frame_;
  msg::WorldState world_;
  std::vector<std::uint32_t> hidden_;  ///< of each robot, as SceneRobot::hidden_dots
};

/// Thresholds from some images in this light, as somebody would learn them who knows where robots stand.
ColourThresholds learned_colours(const Scenario& scenario, const RenderSpec& spec, Rng& rng);

}  // namespace sidestep
