// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>
#include <optional>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/random/rng.hpp"
#include "simulator/rendering/frame_renderer.hpp"
#include "tests/study/vision/oscillating_robots.hpp"
#include "vision/images/image_reader.hpp"
#include "vision/tracking/tracker.hpp"

namespace sidestep {

inline constexpr Field kQuarterField{6, 4.5};  ///< a quarter of a division-A field
inline constexpr std::size_t kRobotsPerTeam = 11;
inline constexpr double kDegrees = 180 / std::numbers::pi;

/// The number of the robot with a given pattern; the inverse of number_in_team().
constexpr RobotId robot_with_pattern(Team team, std::uint32_t pattern) {
  return team == Team::kBlue ? pattern : 16 + pattern;
}

/// A scenario with a grid of cameras over a field, and with all 32 robots of two teams on the roster.
[[nodiscard]] Scenario testbed_scenario(const Field& field, int columns, int rows);

/// Rendered cameras over oscillating robots, and vision that processes their images.
class VisionTestbed {
 public:
  VisionTestbed(const Scenario& scenario, const RenderSpec& spec, const ColourThresholds& colours, Rng& rng);

  /// Starts a new scene with other robots and an empty tracker.
  void reset(std::size_t robots_per_team);
  /// Covers this many randomly chosen dots of each robot.
  void cover_dots(int dots);
  /// Renders the next frames of all cameras.
  void step();

  /// Ground truth of the current frames.
  const std::vector<SceneRobot>& robots() const { return robots_; }
  const SceneBall& ball() const { return ball_; }
  const CameraModel& camera(std::size_t number) const { return renderers_[number].camera(); }
  const std::vector<msg::CameraImage>& images() const { return images_; }
  const Detector& detector(std::size_t camera) const { return reader_.detector(camera); }
  /// Runs detection and tracking on the current frames, and extrapolates the world to their capture time.
  void run_vision();
  const std::vector<msg::DetectionFrame>& detections() const { return detections_; }
  const msg::WorldState& world() const { return world_; }

 private:
  Rng rng_;
  Scenario scenario_;
  std::vector<FrameRenderer> renderers_;
  ImageReader reader_;
  std::optional<OscillatingRobots> oscillating_;
  std::optional<Tracker> tracker_;
  double time_s_ = 1000;
  std::vector<SceneRobot> robots_;
  SceneBall ball_;
  std::vector<msg::CameraImage> images_;
  std::vector<msg::DetectionFrame> detections_;
  Frame frame_;
  msg::WorldState world_;
  std::vector<std::uint32_t> hidden_dots_;  ///< indexed by robot; see SceneRobot::hidden_dots
};

/// Thresholds learned from a few images with known scenes in this light.
[[nodiscard]] ColourThresholds learned_colours(const Scenario& scenario, const RenderSpec& spec, Rng& rng);

}  // namespace sidestep
