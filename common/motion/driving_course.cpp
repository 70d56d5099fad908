// SPDX-License-Identifier: Apache-2.0
#include "common/motion/driving_course.hpp"

#include <algorithm>

namespace sidestep {
namespace {

/// The sample before a time, and the fraction of the interval that has passed since.
struct Place {
  std::size_t sample = 0;
  double fraction = 0;
};

Place place_of(const DrivingCourse& course, Time t) {
  const Duration elapsed = std::clamp(t, course.start, course.end()) - course.start;
  const auto sample = static_cast<std::size_t>(elapsed / DrivingCourse::kSample);
  return {sample, to_seconds(elapsed % DrivingCourse::kSample) / to_seconds(DrivingCourse::kSample)};
}

}  // namespace

State DrivingCourse::state_at(Time t) const {
  const auto [i, f] = place_of(*this, t);
  const State& a = states[i];
  if (i + 1 >= states.size()) return {a.position_m, {0, 0}};
  if (t < start) return {a.position_m, {0, 0}};
  const State& b = states[i + 1];
  // A cubic with the samples' positions and velocities.
  const double h = to_seconds(kSample), g = 1 - f;
  const Vec2 way = b.position_m - a.position_m;
  return {a.position_m + f * f * (3 - 2 * f) * way + h * f * g * (g * a.velocity_mps - f * b.velocity_mps),
          6 * f * g / h * way + g * (1 - 3 * f) * a.velocity_mps + f * (3 * f - 2) * b.velocity_mps};
}

Vec2 DrivingCourse::position_at(Time t) const {
  const auto [i, f] = place_of(*this, t);
  if (i + 1 >= states.size()) return states.back().position_m;
  return states[i].position_m + f * (states[i + 1].position_m - states[i].position_m);
}

}  // namespace sidestep
