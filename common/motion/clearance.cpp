// SPDX-License-Identifier: Apache-2.0
#include "common/motion/clearance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace sidestep {
namespace {

constexpr Duration kForever = Duration::max();

/// Steps through the phases of a trajectory from a time on.
class Walker {
 public:
  Walker(const Trajectory& trajectory, Time from) : trajectory_(trajectory) {
    state_ = trajectory.at_start();
    Duration into = from - trajectory.start();
    const auto phases = trajectory.phases();
    while (index_ < phases.size() && into >= phases[index_].duration) {
      state_ = state_after(state_, phases[index_].acceleration_mps2, to_seconds(phases[index_].duration));
      into -= phases[index_].duration;
      ++index_;
    }
    begin_phase();
    if (index_ < phases.size()) advance(into);
  }

  const State& state() const { return state_; }
  const Vec2& acceleration() const { return acceleration_; }
  /// The time until the acceleration changes.
  Duration left() const { return left_; }

  void advance(Duration step) {
    if (left_ == kForever) return;
    state_ = state_after(state_, acceleration_, to_seconds(step));
    left_ -= step;
    if (left_ > Duration::zero()) return;
    ++index_;
    begin_phase();
  }

 private:
  void begin_phase() {
    const auto phases = trajectory_.phases();
    while (index_ < phases.size() && phases[index_].duration == Duration::zero()) ++index_;
    if (index_ < phases.size()) {
      acceleration_ = phases[index_].acceleration_mps2;
      left_ = phases[index_].duration;
    } else {
      acceleration_ = state_.velocity_mps = Vec2::Zero();
      left_ = kForever;
    }
  }

  const Trajectory& trajectory_;
  State state_;
  Vec2 acceleration_{0, 0};
  Duration left_ = kForever;
  std::size_t index_ = 0;
};

/// Relative motion d + v t + a t^2 / 2 on [0, seconds].
struct Piece {
  Vec2 d, v, a;
  double seconds;

  double squared_distance(double t) const { return (d + t * (v + (0.5 * t) * a)).squaredNorm(); }
};

/// Half the derivative of the squared distance of a piece: c0 + c1 t + c2 t^2 + c3 t^3.
struct Slope {
  double c0, c1, c2, c3;

  explicit Slope(const Piece& p)
      : c0(p.d.dot(p.v)),
        c1(p.v.squaredNorm() + p.d.dot(p.a)),
        c2(1.5 * p.v.dot(p.a)),
        c3(0.5 * p.a.squaredNorm()) {}
  double at(double t) const { return c0 + t * (c1 + t * (c2 + t * c3)); }
  double derivative(double t) const { return c1 + t * (2 * c2 + t * (3 * c3)); }

  /// The extrema of the slope in ascending order; returns their number.
  int extrema(std::array<double, 2>& roots) const {
    const double a = 3 * c3, b = c2;  // a t^2 + 2 b t + c1 = 0
    const double discriminant = b * b - a * c1;
    if (discriminant < 0) return 0;
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));
    int count = 0;
    // Numerically stable form without cancellation.
    if (a != 0) roots[static_cast<std::size_t>(count++)] = q / a;
    if (q != 0) roots[static_cast<std::size_t>(count++)] = c1 / q;
    if (count == 2 && roots[0] > roots[1]) std::swap(roots[0], roots[1]);
    return count;
  }

  /// The zero in [low, high]. Precondition: the slope is negative at low, positive at high, and monotonic.
  double zero(double low, double high) const {
    double t = 0.5 * (low + high);
    for (int i = 0; i < 100 && high - low > 1e-15 * high; ++i) {
      const double value = at(t);
      if (value == 0) return t;
      (value < 0 ? low : high) = t;
      const double rate = derivative(t);
      const double newton = rate > 0 ? t - value / rate : low;
      const double next = newton > low && newton < high ? newton : 0.5 * (low + high);
      if (std::abs(next - t) <= 1e-14) return next;
      t = next;
    }
    return t;
  }
};

/// The minimum squared distance in the interior of the piece; the caller handles its ends.
double min_squared_distance(const Piece& piece) {
  const Slope slope(piece);
  std::array<double, 2> extrema{};
  const int count = slope.extrema(extrema);
  double minimum = std::numeric_limits<double>::infinity();
  double low = 0, slope_low = slope.c0;
  for (int i = 0; i <= count; ++i) {
    double high = i < count ? extrema[static_cast<std::size_t>(i)] : piece.seconds;
    if (!(high > low)) continue;
    high = std::min(high, piece.seconds);
    const double slope_high = slope.at(high);
    if (slope_low < 0 && slope_high > 0) {
      minimum = std::min(minimum, piece.squared_distance(slope.zero(low, high)));
    } else {
      // A minimum at a bound of the bracket.
      minimum = std::min(minimum, piece.squared_distance(high));
    }
    low = high;
    slope_low = slope_high;
    if (high >= piece.seconds) break;
  }
  return minimum;
}

/// Conservative: false only if the motion along the line of centres cannot come within `far_m`.
bool may_come_within(const Piece& piece, double far_m) {
  const double distance = piece.d.norm();
  const double closing = std::min(0.0, piece.seconds * piece.d.dot(piece.v)) +
                         std::min(0.0, 0.5 * piece.seconds * piece.seconds * piece.d.dot(piece.a));
  return distance * distance + closing < (far_m + kClearanceTolerance_m) * distance;
}

/// The minimum squared distance over the pieces of the relative motion. Ends early when `stop(squared
/// distance)` is true, and skips the interior of pieces that stay beyond `far_m`.
template <typename Stop>
double min_squared_distance(const Trajectory& a, const Trajectory& b, double far_m, Stop stop) {
  const Time from = std::max(a.start(), b.start());
  Walker walk_a(a, from), walk_b(b, from);
  double minimum = (walk_a.state().position_m - walk_b.state().position_m).squaredNorm();
  while (!stop(minimum)) {
    const Duration step = std::min(walk_a.left(), walk_b.left());
    if (step == kForever) break;
    const Piece piece{walk_a.state().position_m - walk_b.state().position_m,
                      walk_a.state().velocity_mps - walk_b.state().velocity_mps,
                      walk_a.acceleration() - walk_b.acceleration(), to_seconds(step)};
    if (may_come_within(piece, far_m)) minimum = std::min(minimum, min_squared_distance(piece));
    walk_a.advance(step);
    walk_b.advance(step);
    minimum = std::min(minimum, (walk_a.state().position_m - walk_b.state().position_m).squaredNorm());
  }
  return minimum;
}

}  // namespace

double clearance_m(const Trajectory& a, const Trajectory& b, double min_separation_m) {
  const double squared =
      min_squared_distance(a, b, std::numeric_limits<double>::infinity(), [](double) { return false; });
  return std::sqrt(squared) - min_separation_m - kClearanceTolerance_m;
}

bool is_clear(const Trajectory& a, const Trajectory& b, double min_separation_m) {
  const double far_m = min_separation_m + kClearanceTolerance_m;
  const double min_squared = far_m * far_m;
  return min_squared_distance(a, b, far_m, [=](double squared) { return squared < min_squared; }) >=
         min_squared;
}

double clearance_m(const Trajectory& a, const Vec2& centre_m, double min_separation_m) {
  return clearance_m(a, Trajectory::resting(a.start(), centre_m), min_separation_m);
}

bool is_clear(const Trajectory& a, const Vec2& centre_m, double min_separation_m) {
  return is_clear(a, Trajectory::resting(a.start(), centre_m), min_separation_m);
}

}  // namespace sidestep
