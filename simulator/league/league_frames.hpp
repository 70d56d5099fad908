// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "common/camera/camera_model.hpp"
#include "common/config/scenario.hpp"
#include "common/league/vision_packet.hpp"
#include "idl/vision.h"
#include "simulator/cameras.hpp"

namespace sidestep {

/// Makes of the cameras' frames what SSL-Vision would send. Robots go by team and number; opponents have
/// neither and are sent as yellow robots without a number and a heading.
class LeagueFrames {
 public:
  /// Throws std::invalid_argument when two robots of the scenario have one team and number, or when there are
  /// more cameras than the league numbers.
  LeagueFrames(const Scenario& scenario, std::span<const CameraView> views);

  /// The detections of one camera, sent now. Precondition: the frame is one of those cameras'.
  league::VisionPacket detection(const msg::DetectionFrame& frame, Time now);
  /// The field and all cameras.
  league::VisionPacket geometry() const;

 private:
  void add(const msg::RobotDetection& robot, const CameraModel& camera, league::Detection& detection) const;

  Scenario scenario_;
  std::vector<CameraModel> cameras_;
  std::vector<std::uint32_t> frame_numbers_;  ///< of each camera's latest frame
};

}  // namespace sidestep
