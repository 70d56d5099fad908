// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/random/rng.hpp"
#include "idl/vision.h"
#include "simulator/body.hpp"

namespace sidestep {

/// The part of the floor that a camera sees.
struct CameraView {
  Vec2 low_m;
  Vec2 high_m;
  bool sees(const Vec2& p) const {
    return (p.array() >= low_m.array()).all() && (p.array() <= high_m.array()).all();
  }
};

/// What there is to see.
struct Sights {
  std::span<const Body> robots;  ///< as the scenario lists them
  const Vec2* ball_m = nullptr;
  std::span<const Circle> opponents{};
};

/// The cameras over the field. Each takes a frame every period, a little after the one before it, and sees
/// robots, ball and opponents as the scenario's VisionSpec says.
class Cameras {
 public:
  Cameras(const Scenario& scenario, Time begin, std::uint64_t seed);

  /// When the next frame is to be taken.
  Time next_capture() const { return due_[next_]; }
  /// Takes that frame, of what is there now, and leaves out the camera's frames that should have been before.
  /// All but the head is set.
  void capture(Time now, const Sights& sights, msg::DetectionFrame& frame);

  std::span<const CameraView> views() const { return views_; }

 private:
  void see_opponents(const CameraView& view, std::span<const Circle> opponents, msg::DetectionFrame& frame);
  void add_ghost(const CameraView& view, msg::DetectionFrame& frame);
  void find_next();

  VisionSpec spec_;
  std::vector<RobotId> ids_;
  std::vector<CameraView> views_;
  std::vector<Time> due_;
  std::size_t next_ = 0;
  Duration period_;
  Rng rng_;
};

}  // namespace sidestep
