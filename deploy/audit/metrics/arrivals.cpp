// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/metrics/arrivals.hpp"

#include <fmt/format.h>

namespace sidestep {

std::string arrivals_text(const Arrivals& arrivals, const std::string& when) {
  if (arrivals.without_goal > 0 && arrivals.with_goal() == 0)
    return fmt::format("{} robots without a goal", arrivals.robots);
  const std::string text =
      fmt::format("{} of {} robots arrived{}", arrivals.arrived, arrivals.with_goal(), when);
  return arrivals.without_goal == 0 ? text
                                    : fmt::format("{} and {} had no goal", text, arrivals.without_goal);
}

}  // namespace sidestep
