// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/random/rng.hpp"
#include "idl/vision.hpp"
#include "simulator/world/body.hpp"
#include "simulator/world/vision_fault.hpp"

namespace sidestep {

/// The part of the floor that a camera sees.
struct CameraView {
  Vec2 low_m;
  Vec2 high_m;
  bool sees(const Vec2& p) const {
    return (p.array() >= low_m.array()).all() && (p.array() <= high_m.array()).all();
  }
};

/// The objects on the floor that cameras may detect.
struct VisibleObjects {
  std::span<const Body> robots;  ///< in the scenario's order
  const Vec2* ball_m = nullptr;
  std::span<const Circle> opponents{};
  std::span<const VisionFault> vision_faults{};  ///< faults in how cameras see the robots; empty: no faults
};

/// The cameras over the field. They capture in turn, each once per period, and detect robots, ball and
/// opponents with the noise and dropouts of the scenario's VisionSpec.
class Cameras {
 public:
  /// Each camera sees everything displaced by `outward_error_m`, away from the field's centre, so that two
  /// cameras disagree where both see. A camera above the centre has no error.
  Cameras(const Scenario& scenario, Time begin, std::uint64_t seed, double outward_error_m = 0);

  /// The time at which the next frame is due.
  Time next_capture() const { return due_[next_]; }
  /// Captures the next frame from the given objects, and drops the camera's overdue frames. Sets everything
  /// except the header. If there are more opponents than a frame holds, lists those nearest to the detected
  /// robots.
  void capture(Time now, const VisibleObjects& objects, msg::DetectionFrame& frame);

  std::span<const CameraView> views() const { return views_; }

 private:
  void detect_robot(std::size_t robot, const Body& body, const VisionFault& error, const CameraView& view,
                    msg::DetectionFrame& frame);
  void detect_opponents(const CameraView& view, std::span<const Circle> opponents,
                        msg::DetectionFrame& frame);
  void add_ghost(const CameraView& view, msg::DetectionFrame& frame);
  void select_next_camera();
  static void displace(const Vec2& error_m, msg::DetectionFrame& frame);

  VisionSpec spec_;
  std::vector<RobotId> ids_;
  std::vector<CameraView> views_;
  std::vector<Vec2> errors_m_;  ///< constant error of each camera
  std::vector<Time> due_;
  std::size_t next_ = 0;
  Duration period_;
  Rng rng_;
  std::vector<Circle> seen_opponents_;  // opponents in the frame that is being captured
};

}  // namespace sidestep
