// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace sidestep::robot {

/// Numbers in this folder that come from messages or go into messages are doubles, as on the wire, and are
/// never recomputed. Values that the robot computes for itself have the type `Real`, float or double.
template <typename Real>
struct Vec {
  Real x = 0, y = 0;
};

template <typename Real>
constexpr Real squared_norm(const Vec<Real>& v) {
  return v.x * v.x + v.y * v.y;
}

inline float square_root(float x) { return __builtin_sqrtf(x); }
inline double square_root(double x) { return __builtin_sqrt(x); }

template <typename Real>
Real norm(const Vec<Real>& v) {
  return square_root(squared_norm(v));
}

constexpr double seconds_of(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

/// A part of a trajectory with constant acceleration.
struct Phase {
  std::int64_t duration_ns = 0;
  double ax_mps2 = 0, ay_mps2 = 0;
};

/// The agent's intended motion beyond a version. The robot only reports it.
struct Intent {
  float vx_mps = 0, vy_mps = 0, velocity_duration_s = 0;
  float waypoint_x_m = 0, waypoint_y_m = 0;
  float goal_x_m = 0, goal_y_m = 0;
  float target_x_m = 0, target_y_m = 0;
  std::int64_t due_ns = 0;
};

/// One version of the robot's trajectory, with the fields of Version in idl/trajectory.idl: from start_ns on,
/// the robot executes the phases in order, then rests.
struct Version {
  static constexpr int kMaxPhases = 4;

  std::uint64_t incarnation = 0, number = 0, base = 0;
  std::int64_t start_ns = 0;
  double x_m = 0, y_m = 0, vx_mps = 0, vy_mps = 0;
  double inflation_m = 0;
  bool has_intent = false;
  Intent intent;
  int phase_count = 0;
  Phase phases[kMaxPhases];

  std::int64_t end_ns() const {
    std::int64_t end = start_ns;
    for (int i = 0; i < phase_count; ++i) end += phases[i].duration_ns;
    return end;
  }
  /// Whether the robot is at rest throughout.
  bool is_rest() const { return phase_count == 0 && vx_mps == 0 && vy_mps == 0; }
};

template <typename Real>
struct Motion {
  Vec<Real> position_m, velocity_mps, acceleration_mps2;
};

/// The state and acceleration that a version prescribes at a time: its start state before the start, and rest
/// from its end on.
template <typename Real>
Motion<Real> motion_at(const Version& version, std::int64_t t_ns) {
  Vec<Real> p{static_cast<Real>(version.x_m), static_cast<Real>(version.y_m)};
  Vec<Real> v{static_cast<Real>(version.vx_mps), static_cast<Real>(version.vy_mps)};
  if (t_ns < version.start_ns) return {p, v, {}};
  std::int64_t left_ns = t_ns - version.start_ns;
  for (int i = 0; i < version.phase_count; ++i) {
    const Phase& phase = version.phases[i];
    const Vec<Real> a{static_cast<Real>(phase.ax_mps2), static_cast<Real>(phase.ay_mps2)};
    const bool is_within = left_ns < phase.duration_ns;
    const auto s = static_cast<Real>(seconds_of(is_within ? left_ns : phase.duration_ns));
    const Real half_s = Real(0.5) * s;
    p = {p.x + s * (v.x + half_s * a.x), p.y + s * (v.y + half_s * a.y)};
    v = {v.x + s * a.x, v.y + s * a.y};
    if (is_within) return {p, v, a};
    left_ns -= phase.duration_ns;
  }
  return {p, {}, {}};
}

}  // namespace sidestep::robot
