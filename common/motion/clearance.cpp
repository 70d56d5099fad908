// SPDX-License-Identifier: Apache-2.0
#include "common/motion/clearance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace sidestep {
namespace {

constexpr Duration kForever = Duration::max();

/// Iterates over the phases of a trajectory, starting at a given time.
class TrajectoryCursor {
 public:
  TrajectoryCursor(const Trajectory& trajectory, Time from) : trajectory_(trajectory) {
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
  /// The time until the acceleration changes next.
  Duration remaining() const { return remaining_; }

  void advance(Duration step) {
    if (remaining_ == kForever) return;
    state_ = state_after(state_, acceleration_, to_seconds(step));
    remaining_ -= step;
    if (remaining_ > Duration::zero()) return;
    ++index_;
    begin_phase();
  }

 private:
  void begin_phase() {
    const auto phases = trajectory_.phases();
    while (index_ < phases.size() && phases[index_].duration == Duration::zero()) ++index_;
    if (index_ < phases.size()) {
      acceleration_ = phases[index_].acceleration_mps2;
      remaining_ = phases[index_].duration;
    } else {
      acceleration_ = state_.velocity_mps = Vec2::Zero();
      remaining_ = kForever;
    }
  }

  const Trajectory& trajectory_;
  State state_;
  Vec2 acceleration_{0, 0};
  Duration remaining_ = kForever;
  std::size_t index_ = 0;
};

/// Relative motion d + v t + a t^2 / 2 over [0, seconds].
struct RelativeMotion {
  Vec2 d, v, a;
  double seconds;

  double squared_distance(double t) const { return (d + t * (v + (0.5 * t) * a)).squaredNorm(); }
};

/// Half the derivative of the squared distance of a motion: c0 + c1 t + c2 t^2 + c3 t^3.
struct DistanceDerivative {
  double c0, c1, c2, c3;

  explicit DistanceDerivative(const RelativeMotion& motion)
      : c0(motion.d.dot(motion.v)),
        c1(motion.v.squaredNorm() + motion.d.dot(motion.a)),
        c2(1.5 * motion.v.dot(motion.a)),
        c3(0.5 * motion.a.squaredNorm()) {}
  double at(double t) const { return c0 + t * (c1 + t * (c2 + t * c3)); }
  double second_derivative(double t) const { return c1 + t * (2 * c2 + t * (3 * c3)); }

  /// The extrema of the derivative in ascending order; returns their number.
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

  /// The zero in [low, high]. Precondition: the derivative is negative at low, positive at high, and
  /// monotonic.
  double zero(double low, double high) const {
    double t = 0.5 * (low + high);
    for (int i = 0; i < 100 && high - low > 1e-15 * high; ++i) {
      const double value = at(t);
      if (value == 0) return t;
      (value < 0 ? low : high) = t;
      const double rate = second_derivative(t);
      const double newton = rate > 0 ? t - value / rate : low;
      const double next = newton > low && newton < high ? newton : 0.5 * (low + high);
      if (std::abs(next - t) <= 1e-14) return next;
      t = next;
    }
    return t;
  }
};

/// The minimum squared distance in the interior of the motion; the caller handles its ends.
double min_squared_distance(const RelativeMotion& motion) {
  const DistanceDerivative derivative(motion);
  std::array<double, 2> extrema{};
  const int count = derivative.extrema(extrema);
  double minimum = std::numeric_limits<double>::infinity();
  double low = 0, derivative_low = derivative.c0;
  for (int i = 0; i <= count; ++i) {
    double high = i < count ? extrema[static_cast<std::size_t>(i)] : motion.seconds;
    if (!(high > low)) continue;
    high = std::min(high, motion.seconds);
    const double derivative_high = derivative.at(high);
    if (derivative_low < 0 && derivative_high > 0) {
      minimum = std::min(minimum, motion.squared_distance(derivative.zero(low, high)));
    } else {
      // The minimum is at a bound of the bracket.
      minimum = std::min(minimum, motion.squared_distance(high));
    }
    low = high;
    derivative_low = derivative_high;
    if (high >= motion.seconds) break;
  }
  return minimum;
}

/// Returns `minimum`, or NaN if `last_m` is not finite because the motion contained NaN or infinity: std::min
/// ignores NaN.
double or_nan(double minimum, const Vec2& last_m) { return minimum + 0 * last_m.squaredNorm(); }

/// Whether the motion may come within `far_m`. Conservative: false only if its component along the line of
/// centres cannot.
bool may_come_within(const RelativeMotion& motion, double far_m) {
  const double distance = motion.d.norm();
  const double closing = std::min(motion.seconds * motion.d.dot(motion.v), 0.0) +
                         std::min(0.5 * motion.seconds * motion.seconds * motion.d.dot(motion.a), 0.0);
  return !(distance * distance + closing >= (far_m + kClearanceTolerance_m) * distance);
}

/// The minimum squared distance over the phases of the relative motion. Ends early when `stop(squared
/// distance)` is true, and skips the interior of phases that stay beyond `far_m`.
template <typename Stop>
double min_squared_distance(const Trajectory& a, const Trajectory& b, double far_m, Stop stop) {
  const Time from = std::max(a.start(), b.start());
  TrajectoryCursor cursor_a(a, from), cursor_b(b, from);
  double minimum = (cursor_a.state().position_m - cursor_b.state().position_m).squaredNorm();
  while (!stop(minimum)) {
    const Duration step = std::min(cursor_a.remaining(), cursor_b.remaining());
    if (step == kForever) break;
    const RelativeMotion motion{cursor_a.state().position_m - cursor_b.state().position_m,
                                cursor_a.state().velocity_mps - cursor_b.state().velocity_mps,
                                cursor_a.acceleration() - cursor_b.acceleration(), to_seconds(step)};
    if (may_come_within(motion, far_m)) minimum = std::min(minimum, min_squared_distance(motion));
    cursor_a.advance(step);
    cursor_b.advance(step);
    minimum = std::min(minimum, (cursor_a.state().position_m - cursor_b.state().position_m).squaredNorm());
  }
  return or_nan(minimum, cursor_a.state().position_m - cursor_b.state().position_m);
}

/// The minimum squared distance of a motion from an edge at times when it moves parallel to the edge, and 0
/// if it crosses the edge. The caller handles the ends of the motion and of the edge.
double min_squared_distance(const RelativeMotion& motion, const Segment& edge) {
  const Vec2 along = edge.to_m - edge.from_m;
  const Vec2 normal(-along.y(), along.x());
  // Signed distance from the edge's line times the edge's length: q0 + q1 t + q2 t^2.
  const double q0 = normal.dot(motion.d - edge.from_m), q1 = normal.dot(motion.v),
               q2 = 0.5 * normal.dot(motion.a);
  double minimum = std::numeric_limits<double>::infinity();
  const auto add = [&](double t) {
    if (!(t > 0 && t < motion.seconds)) return;
    const Vec2 position = motion.d + t * (motion.v + (0.5 * t) * motion.a);
    minimum = std::min(minimum, squared_distance(position, edge));
  };
  if (q2 != 0) add(-q1 / (2 * q2));
  const double discriminant = q1 * q1 - 4 * q2 * q0;
  if (discriminant < 0) return minimum;
  const double q = -0.5 * (q1 + std::copysign(std::sqrt(discriminant), q1));
  if (q2 != 0) add(q / q2);
  if (q != 0) add(q0 / q);
  return minimum;
}

/// The minimum squared distance from a trajectory to the boundary of a polygon. Precondition: the trajectory
/// starts outside the polygon. A segment counts as a polygon with two corners. Ends early when `stop(squared
/// distance)` is true.
template <typename Stop>
double min_squared_distance(const Trajectory& a, std::span<const Vec2> corners, double far_m, Stop stop) {
  TrajectoryCursor cursor(a, a.start());
  double minimum = std::numeric_limits<double>::infinity();
  const auto add_position = [&] {
    for (std::size_t i = 0, last = corners.size() - 1; i < corners.size(); last = i++)
      minimum =
          std::min(minimum, squared_distance(cursor.state().position_m, Segment{corners[last], corners[i]}));
  };
  add_position();
  while (!stop(minimum) && cursor.remaining() != kForever) {
    const Duration step = cursor.remaining();
    RelativeMotion motion{cursor.state().position_m, cursor.state().velocity_mps, cursor.acceleration(),
                          to_seconds(step)};
    for (std::size_t i = 0, last = corners.size() - 1; i < corners.size(); last = i++) {
      minimum = std::min(minimum, min_squared_distance(motion, Segment{corners[last], corners[i]}));
      RelativeMotion from_corner = motion;
      from_corner.d -= corners[i];
      if (may_come_within(from_corner, far_m)) minimum = std::min(minimum, min_squared_distance(from_corner));
    }
    cursor.advance(step);
    add_position();
  }
  return or_nan(minimum, cursor.state().position_m);
}

/// The corners of any shape except a circle.
struct Corners {
  explicit Corners(const Shape& shape) {
    if (const auto* box = std::get_if<Box>(&shape)) {
      few = corners_of(*box);
      all = few;
    } else if (const auto* segment = std::get_if<Segment>(&shape)) {
      few = {segment->from_m, segment->to_m};
      all = std::span(few).first(2);
    } else {
      all = std::get<ConvexPolygon>(shape).corners_m;
    }
  }
  Corners(const Corners&) = delete;
  Corners& operator=(const Corners&) = delete;

  std::array<Vec2, 4> few;
  std::span<const Vec2> all;
};

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

double clearance_m(const Trajectory& a, const Shape& shape, double min_separation_m) {
  if (const auto* circle = std::get_if<Circle>(&shape))
    return clearance_m(a, circle->centre_m, circle->radius_m + min_separation_m);
  if (signed_distance(a.at_start().position_m, shape) <= 0) return -std::numeric_limits<double>::infinity();
  const Corners corners(shape);
  const double squared = min_squared_distance(a, corners.all, std::numeric_limits<double>::infinity(),
                                              [](double) { return false; });
  const double distance_m = std::sqrt(squared) - kClearanceTolerance_m;
  return distance_m > 0 ? distance_m - min_separation_m : -std::numeric_limits<double>::infinity();
}

bool is_clear(const Trajectory& a, const Shape& shape, double min_separation_m) {
  if (const auto* circle = std::get_if<Circle>(&shape)) {
    const double separation_m = circle->radius_m + min_separation_m;
    const double far_m = separation_m + kClearanceTolerance_m + reach_m(a);
    return (circle->centre_m - a.at_start().position_m).squaredNorm() > far_m * far_m ||
           is_clear(a, circle->centre_m, separation_m);
  }
  const double far_m = std::max(min_separation_m, 0.0) + kClearanceTolerance_m;
  const double distance_m = or_nan(signed_distance(a.at_start().position_m, shape), a.at_start().position_m);
  if (!(distance_m > 0)) return false;
  if (distance_m >= far_m + reach_m(a)) return true;
  const Corners corners(shape);
  const double min_squared = far_m * far_m;
  return min_squared_distance(a, corners.all, far_m, [=](double squared) { return squared < min_squared; }) >=
         min_squared;
}

bool is_clear(const Trajectory& a, const FloorMap& map, double min_separation_m) {
  return for_each_near_box(a, map, min_separation_m, [](const Box&) { return false; });
}

bool for_each_near_box(const Trajectory& a, const FloorMap& map, double min_separation_m,
                       const std::function<bool(const Box&)>& call) {
  // The path is divided into pieces of this length, each of which is near few boxes.
  constexpr double kPiece_m = 1;
  const double far_m = std::max(min_separation_m, 0.0) + 2 * kClearanceTolerance_m;
  const auto visit = [&](const Trajectory& piece, double length_m) {
    const Vec2 &from = piece.at_start().position_m, to = piece.rest_position_m();
    // Every point of a path is within half the path's length of the midpoint of its ends.
    const Vec2 middle = 0.5 * (from + to);
    const double reach_m = 0.5 * length_m + far_m;
    if (map.field().lower_bound_m(middle) > reach_m) return true;
    const Vec2 half = Vec2::Constant(reach_m);
    return map.cells().for_each_box({middle - half, middle + half}, [&](const Box& box) {
      return is_clear(piece, Shape(box), min_separation_m) || call(box);
    });
  };
  State state = a.at_start();
  if (a.phases().empty()) return visit(a, 0);
  for (const MotionPhase& phase : a.phases()) {
    const double seconds = to_seconds(phase.duration);
    const double end_mps = (state.velocity_mps + seconds * phase.acceleration_mps2).norm();
    // The speed is a convex function of time over a phase, so its maximum is at one of the ends.
    const double length_m = seconds * std::max(state.velocity_mps.norm(), end_mps);
    const auto pieces = static_cast<std::int64_t>(std::ceil(length_m / kPiece_m));
    Duration begin{0};
    for (std::int64_t i = 1; i <= std::max<std::int64_t>(pieces, 1); ++i) {
      const Duration end = pieces > 1 ? phase.duration * i / pieces : phase.duration;
      Trajectory piece(a.start(), state_after(state, phase.acceleration_mps2, to_seconds(begin)));
      piece.append(end - begin, phase.acceleration_mps2);
      const double part_s = to_seconds(end - begin);
      const double piece_m =
          part_s *
          std::max(state_after(state, phase.acceleration_mps2, to_seconds(begin)).velocity_mps.norm(),
                   state_after(state, phase.acceleration_mps2, to_seconds(end)).velocity_mps.norm());
      if (!visit(piece, piece_m)) return false;
      begin = end;
    }
    state = state_after(state, phase.acceleration_mps2, seconds);
  }
  return true;
}

}  // namespace sidestep
