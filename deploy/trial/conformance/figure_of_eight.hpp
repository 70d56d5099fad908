// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "common/geometry/vec2.hpp"

namespace sidestep {

/// The lemniscate of Gerono: x = a sin(t), y = a/2 sin(2 t).
class FigureOfEight {
 public:
  explicit FigureOfEight(double amplitude_m) : amplitude_m_(amplitude_m) {}
  Vec2 at(double t) const { return amplitude_m_ * Vec2(std::sin(t), 0.5 * std::sin(2 * t)); }
  Vec2 derivative(double t) const { return amplitude_m_ * Vec2(std::cos(t), std::cos(2 * t)); }
  double curvature_pm(double t) const {
    const Vec2 first = derivative(t), second = -amplitude_m_ * Vec2(std::sin(t), 2 * std::sin(2 * t));
    return std::abs(cross(first, second)) / std::pow(first.norm(), 3);
  }

 private:
  double amplitude_m_;
};

}  // namespace sidestep
