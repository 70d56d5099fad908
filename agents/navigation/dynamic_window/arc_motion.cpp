// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/dynamic_window/arc_motion.hpp"

namespace sidestep {

Vec2 displacement_m(const ArcMotion& motion, double seconds) {
  const double half_rad = motion.turn_rate_radps * seconds / 2;
  // The chord of the arc; sin(x)/x is 1 within rounding for small x.
  const double ratio = std::abs(half_rad) < 1e-9 ? 1 : std::sin(half_rad) / half_rad;
  const double chord_m = motion.speed_mps * seconds * ratio;
  return {chord_m * std::cos(half_rad), chord_m * std::sin(half_rad)};
}

Vec2 point_after_motion(const Vec2& point_m, const ArcMotion& motion, double seconds) {
  return rotated(point_m - displacement_m(motion, seconds), -motion.turn_rate_radps * seconds);
}

Crossing first_crossing(const Vec2& point_m, double offset_m, const Vec2& normal, const ArcMotion& motion) {
  const double v = motion.speed_mps, w = motion.turn_rate_radps;
  // The distance from the line is (a s² + b s + offset) / (1 + (w s / 2)²), where b is its initial rate.
  const double b = normal.x() * (w * point_m.y() - v) - normal.y() * w * point_m.x();
  const double a = w * (w * (offset_m - 2 * normal.dot(point_m)) + 2 * normal.y() * v) / 4;
  const double under_root = b * b - 4 * a * offset_m;
  if (under_root < 0) return {};
  const double root = std::sqrt(under_root);
  // s = over / under is the root at which the distance decreases, in a form without cancellation.
  double over = b < 0 ? 2 * offset_m : -b - root;
  double under = b < 0 ? root - b : 2 * a;
  if (over < 0 || (over == 0 && under < 0)) {
    over = -over;
    under = -under;
  }
  if (w == 0) {
    if (under <= 0) return {};
    const double seconds = over / under;
    return {seconds, {point_m.x() - v * seconds, point_m.y()}};
  }
  const double across = w / 2 * over, length = std::hypot(across, under);
  if (length == 0) return {};
  // Sine and cosine of half the turn.
  const double sine = across / length, cosine = under / length, along = over / length;
  const double turn_sine = 2 * sine * cosine, turn_versine = 2 * sine * sine;
  const Vec2 at(point_m.x() - turn_versine * point_m.x() + turn_sine * point_m.y() - v * along * cosine,
                point_m.y() - turn_versine * point_m.y() - turn_sine * point_m.x() + v * along * sine);
  return {2 * std::atan2(std::abs(across), under) / std::abs(w), at};
}

}  // namespace sidestep
