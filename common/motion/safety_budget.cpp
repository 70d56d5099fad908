// SPDX-License-Identifier: Apache-2.0
#include "common/motion/safety_budget.hpp"

#include <fmt/format.h>

namespace sidestep {

std::string budget_line(const SafetyBudget& budget, double margin_m) {
  const double clocks_m = budget.required_margin_m() - 2 * budget.tracking_bound_m;
  std::string line = fmt::format(
      "safety budget: margin {:.1f} mm = 2 x {:.1f} mm tracking + {:.1f} mm for clocks within {:.3g} ms at "
      "{:.3g} m/s",
      margin_m * 1e3, budget.tracking_bound_m * 1e3, clocks_m * 1e3, budget.clock_bound_s * 1e3,
      budget.speed_mps);
  const double spare_m = margin_m - budget.required_margin_m();
  if (spare_m >= 0.00005) line += fmt::format(" + {:.1f} mm to spare", spare_m * 1e3);
  return line;
}

}  // namespace sidestep
