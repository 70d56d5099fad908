// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <span>
#include <string>

#include "common/motion/version.hpp"

namespace sidestep {

/// Names robots that move, e.g. "robots 3, 7 still move"; empty if there are none.
inline std::string still_moving_text(std::span<const RobotId> robots) {
  if (robots.empty()) return {};
  if (robots.size() == 1) return fmt::format("robot {} still moves", robots.front());
  return fmt::format("robots {} still move", fmt::join(robots, ", "));
}

}  // namespace sidestep
