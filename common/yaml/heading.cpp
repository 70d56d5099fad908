// SPDX-License-Identifier: Apache-2.0
#include "common/yaml/heading.hpp"

#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace sidestep {

std::string heading_problem(double heading_rad) {
  if (std::abs(heading_rad) <= 2 * std::numbers::pi) return "";
  const std::string expected =
      fmt::format("expected a heading of -6.28 to 6.28 radians, got {:.10g}", heading_rad);
  constexpr double kWholeTurn_deg = 360;
  if (!(std::abs(heading_rad) <= kWholeTurn_deg)) return expected;
  return fmt::format("{}; {:.10g} degrees are {:.4g} radians", expected, heading_rad,
                     heading_rad * std::numbers::pi / 180);
}

}  // namespace sidestep
