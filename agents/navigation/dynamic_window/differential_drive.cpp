// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/dynamic_window/differential_drive.hpp"

#include <stdexcept>

namespace sidestep {

WheelSpeeds DifferentialDrive::braked(const WheelSpeeds& wheels, double seconds) const {
  const double rest_s = time_to_brake_s(wheels);
  if (rest_s <= seconds) return {};
  const double fraction = 1 - seconds / rest_s;
  return {fraction * wheels.left_mps, fraction * wheels.right_mps};
}

void check(const DifferentialDrive& drive) {
  for (const double value : {drive.wheel_base_m, drive.wheel_speed_mps, drive.wheel_acceleration_mps2,
                             drive.speed_mps, drive.turn_rate_radps}) {
    if (!(value > 0) || !std::isfinite(value))
      throw std::invalid_argument("dimensions and limits of a differential drive have to be positive");
  }
}

}  // namespace sidestep
