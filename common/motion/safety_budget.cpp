// SPDX-License-Identifier: Apache-2.0
#include "common/motion/safety_budget.hpp"

#include <fmt/format.h>

namespace sidestep {
namespace {

/// Half the round-trip time of a message on a fast network. Clock offsets cannot be measured more accurately.
constexpr double kMeasuredOffset_s = 0.0001;

}  // namespace

std::string budget_line(const SafetyBudget& budget, double margin_m) {
  const double clocks_m = budget.required_margin_m() - 2 * budget.tracking_bound_m;
  std::string line = fmt::format(
      "safety budget: margin {:.1f} mm = 2 x {:.1f} mm tracking + {:.1f} mm for clocks within {:.3g} ms at "
      "{:.3g} m/s",
      margin_m * 1e3, budget.tracking_bound_m * 1e3, clocks_m * 1e3, budget.clock_bound_s * 1e3,
      budget.speed_mps);
  const double spare_m = margin_m - budget.required_margin_m();
  if (spare_m >= 0.00005) line += fmt::format(" + {:.1f} mm to spare", spare_m * 1e3);
  // Cameras and robots timestamp observations with clocks that may differ by up to twice the clock bound.
  const double shift_m = 2 * budget.clock_bound_s * budget.speed_mps;
  const double sight_m = vision_error_bound_m(budget.tracking_bound_m);
  if (shift_m > sight_m + 1e-9) {
    line += fmt::format(
        "; warning: clock errors of cameras may shift observed robots by {:.1f} mm; tracking covers "
        "{:.1f} mm: expect own stops, or set tracking_bound_m to {:.1f} mm or more",
        shift_m * 1e3, sight_m * 1e3, shift_m / vision_error_bound_m(1) * 1e3);
  }
  const double measured_mps = budget.max_speed_mps(margin_m, kMeasuredOffset_s);
  if (measured_mps < (1 - 1e-9) * budget.speed_mps) {
    line += fmt::format(
        "; warning: clock offsets are known to {:.1f} ms at best, so the margin allows {:.2g} m/s: set "
        "margin_m to {:.1f} mm or more",
        kMeasuredOffset_s * 1e3, measured_mps,
        2e3 * (budget.tracking_bound_m + kMeasuredOffset_s * budget.speed_mps));
  }
  return line;
}

}  // namespace sidestep
