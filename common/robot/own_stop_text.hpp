// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/robot/robot_side.hpp"

namespace sidestep {

constexpr const char* to_text(robot::OwnStopReason reason) {
  switch (reason) {
    case robot::OwnStopReason::kOffReference:
      return "it is farther from its reference than the tracking bound";
    case robot::OwnStopReason::kDrifted:
      return "it drifted from its reference and did not return in time";
    case robot::OwnStopReason::kDisplaced:
      return "it was displaced without its wheels measuring it";
    case robot::OwnStopReason::kRestart:
      return "its firmware restarted, or it found its pose";
    case robot::OwnStopReason::kClockSetBack:
      return "its clock was set back";
  }
  return "?";
}

}  // namespace sidestep
