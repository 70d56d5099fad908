// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "common/geometry/vec2.hpp"
#include "vision/tracking/frame.hpp"

namespace sidestep {

/// Where a camera has seen a robot.
struct CameraSighting {
  Time captured_at{};
  Vec2 position_m{0, 0};
};

/// Where the camera would have seen the robot at a time between two of its sightings. nullopt if the time is
/// not between them, or if they are not in order or too far apart.
[[nodiscard]] std::optional<Vec2> position_between(const CameraSighting& before, const CameraSighting& after,
                                                   Time at);

/// How far apart two cameras see the same robots.
struct CameraDisagreement {
  std::uint32_t first = 0, second = 0;
  Vec2 offset_m{0, 0};   ///< mean of the second camera's positions minus the first's
  double scatter_m = 0;  ///< standard deviation of these differences on each axis, with the cameras' noise
  int samples = 0;       ///< up to CameraOffsets::kMaxSamples
  bool is_corrected = false;
  int contradictions = 0;  ///< number of consecutive samples far from the mean
};

/// Measures how cameras with overlapping views disagree about robots that both see, and corrects it: badly
/// calibrated cameras would make a robot jump when it passes from one view to the next. The position of one
/// camera is interpolated to the time of the other's frame, so moving robots count, too. Which camera is
/// right is unknown, so both are corrected by half. Corrections change slowly, because a robot that drives
/// must not see itself jump. Allocates only in the constructor.
class CameraOffsets {
 public:
  static constexpr int kMaxSamples = 600;  ///< older samples fade
  static constexpr int kMinSamples = 20;   ///< number of samples before a disagreement is corrected
  /// Smaller disagreements are not corrected.
  static constexpr double kMinOffset_m = 0.003;
  /// Greater differences are not of one robot, or belong to cameras that must be calibrated.
  static constexpr double kMaxOffset_m = 0.15;
  static constexpr double kMaxChange_mps = 0.01;  ///< maximum rate of change of a camera's correction

  explicit CameraOffsets(const std::vector<std::uint32_t>& cameras);

  /// Measures with the uncorrected positions of a usable frame of one of the cameras.
  void add(const Frame& frame);
  /// Moves the corrections towards the measurement during this time.
  void advance(Duration elapsed);
  /// What has to be added to positions of this camera.
  Vec2 correction_m(std::uint32_t camera) const;
  /// All pairs of cameras that have seen the same robots.
  std::span<const CameraDisagreement> pairs() const { return pairs_; }
  /// The standard deviation of positions that explains how much cameras differ that are corrected, as far as
  /// they are; 0 if none is.
  double noise_m() const;
  /// Forgets observations, but not what has been measured. Call it when the clock was set back.
  void forget();

 private:
  struct Sighting : CameraSighting {
    std::uint32_t camera = 0;
  };
  /// The latest sightings of a robot by all cameras, a ring buffer.
  struct Sightings {
    std::array<Sighting, 16> latest{};
    std::size_t next = 0, count = 0;
    const Sighting& back(std::size_t age) const {
      return latest[(next + latest.size() - 1 - age) % latest.size()];
    }
  };
  void compare(const Sightings& robot, const Sighting& now);
  void add_sample(std::uint32_t camera, std::uint32_t other, const Vec2& offset_m);

  std::map<std::uint32_t, Vec2> corrections_m_;  ///< of each camera
  std::vector<CameraDisagreement> pairs_;
  std::vector<Sightings> robots_;  ///< indexed by robot
};

}  // namespace sidestep
