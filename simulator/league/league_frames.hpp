// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "common/camera/camera_model.hpp"
#include "common/config/scenario.hpp"
#include "common/league/vision_packet.hpp"
#include "idl/vision.hpp"
#include "simulator/world/cameras.hpp"

namespace sidestep {

/// Converts the cameras' detections to the packets that SSL-Vision would send. Robots are identified by team
/// and number; opponents have neither, and are sent as yellow robots without number and heading.
class LeagueFrames {
 public:
  /// Throws std::invalid_argument if two robots of the scenario have the same team and number, or if there
  /// are more than league::kMaxCameras cameras.
  LeagueFrames(const Scenario& scenario, std::span<const CameraView> views);

  /// The packet with a camera's detections, sent `now`. Precondition: frame.camera() is an index into
  /// `views`.
  league::VisionPacket detection(const msg::DetectionFrame& frame, Time now);
  /// The packet with the field's geometry and all cameras' calibrations.
  league::VisionPacket geometry() const;

 private:
  void add(const msg::RobotDetection& robot, const CameraModel& camera,
           league::DetectionFrame& detection) const;

  Scenario scenario_;
  std::vector<CameraModel> cameras_;
  std::vector<std::uint32_t> frame_numbers_;  ///< number of each camera's latest frame
};

}  // namespace sidestep
