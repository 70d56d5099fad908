// SPDX-License-Identifier: Apache-2.0
#include "common/svg/axis.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace sidestep {
namespace {

constexpr std::size_t kMaxTicks = 10'000;
constexpr double kSmallestStep = 1e-300, kLargestStep = 1e307;

}  // namespace

double round_step(double min) {
  // NaN becomes the smallest step.
  min = std::min(std::max(kSmallestStep, min), kLargestStep);
  const double power = std::pow(10, std::floor(std::log10(min)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= min * (1 - 1e-9)) return factor * power;
  return 10 * power;
}

std::vector<double> ticks(double from, double to, double step) {
  std::vector<double> values;
  const double first = std::ceil(from / step - 1e-6), last = std::floor(to / step + 1e-6);
  if (!std::isfinite(first) || !std::isfinite(last)) return values;
  for (std::size_t i = 0; i < kMaxTicks; ++i) {
    const double k = first + static_cast<double>(i);
    // Far from zero, multiples of a small step cannot be told apart.
    if (k > last || (!values.empty() && k * step <= values.back())) break;
    values.push_back(k * step);
  }
  return values;
}

std::string tick_label(double value, double step) {
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  // Without this, rounding shows "-0".
  if (std::abs(value) < step / 2) value = 0;
  return fmt::format("{:.{}f}", value, decimals);
}

}  // namespace sidestep
