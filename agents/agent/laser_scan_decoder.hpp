// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "agents/perception/laser_beams.hpp"
#include "common/motion/version.hpp"
#include "idl/laser.hpp"

namespace sidestep {

/// Decodes untrusted scans of a robot's laser. Allocates only in the constructor.
class LaserScanDecoder {
 public:
  LaserScanDecoder(RobotId robot, const LaserSettings& laser);

  /// Returns nullopt unless the robot sent the scan itself, the scan fits this laser, its pose is finite and
  /// plausible, and its time is plausible at `now` (by the local clock). Valid until the next call.
  [[nodiscard]] std::optional<LaserScan> decode(const msg::LaserScan& message, Time now);

 private:
  bool is_possible(const msg::LaserScan& message, Time now) const;

  RobotId robot_;
  LaserSettings laser_;
  std::vector<float> ranges_m_;
};

}  // namespace sidestep
