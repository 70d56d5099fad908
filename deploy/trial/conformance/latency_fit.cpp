// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/conformance/latency_fit.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

constexpr Duration kStep = std::chrono::microseconds(500);
constexpr std::size_t kTried = 2 * (LatencyFit::kMaxLate / kStep) + 1;

Duration tried(double index) { return -LatencyFit::kMaxLate + from_seconds(index * to_seconds(kStep)); }

/// The delay with the smallest error. Near it the error is a parabola of the delay.
Duration best(const std::vector<double>& errors_m2) {
  const auto least = std::min_element(errors_m2.begin(), errors_m2.end());
  const double index = static_cast<double>(least - errors_m2.begin());
  if (least == errors_m2.begin() || least + 1 == errors_m2.end()) return tried(index);
  const double curvature = least[-1] - 2 * least[0] + least[1];
  return tried(curvature > 0 ? index + 0.5 * (least[-1] - least[1]) / curvature : index);
}

}  // namespace

void LatencyFit::add(Time at, const Vec2& seen_m) {
  Start& start = starts_.back();
  start.errors_m2.resize(kTried, 0);
  for (std::size_t i = 0; i < kTried; ++i) {
    const Time reference_at = at - tried(static_cast<double>(i));
    start.errors_m2[i] += (seen_m - start.trajectory.state_at(reference_at).position_m).squaredNorm();
  }
  ++observations_;
}

// The uncertainty is that of the jackknife: the estimates without one start each show how far a start can
// move the result. Observations of one start share errors, so they are not left out singly.
LatencyFit::Result LatencyFit::result() const {
  Errors all(kTried, 0);
  double starts = 0;
  for (const Start& start : starts_) {
    if (start.errors_m2.empty()) continue;
    ++starts;
    for (std::size_t i = 0; i < kTried; ++i) all[i] += start.errors_m2[i];
  }
  const Duration late = best(all);
  if (starts < 2) return {late, kMaxLate};
  double square_s2 = 0;
  for (const Start& start : starts_) {
    if (start.errors_m2.empty()) continue;
    Errors others = all;
    for (std::size_t i = 0; i < kTried; ++i) others[i] -= start.errors_m2[i];
    const double change_s = to_seconds(best(others) - late);
    square_s2 += change_s * change_s;
  }
  // Few starts show their own spread badly: the bound is that of Student's t with `starts - 1` degrees of
  // freedom (Abramowitz and Stegun, Handbook of Mathematical Functions, 26.7.5, first order).
  const double deviations = 2 * (1 + 1.25 / (starts - 1));
  return {late, from_seconds(deviations * std::sqrt((starts - 1) / starts * square_s2))};
}

}  // namespace sidestep
