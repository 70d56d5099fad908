// SPDX-License-Identifier: Apache-2.0
#include "common/svg/axis.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace sidestep {

double round_step(double min) {
  const double power = std::pow(10, std::floor(std::log10(min)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= min * (1 - 1e-9)) return factor * power;
  return 10 * power;
}

std::vector<double> ticks(double from, double to, double step) {
  std::vector<double> values;
  const double last = std::floor(to / step + 1e-6);
  for (double k = std::ceil(from / step - 1e-6); k <= last; ++k) values.push_back(k * step);
  return values;
}

std::string tick_label(double value, double step) {
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  // Without this, rounding shows "-0".
  if (std::abs(value) < step / 2) value = 0;
  return fmt::format("{:.{}f}", value, decimals);
}

}  // namespace sidestep
