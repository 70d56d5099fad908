// SPDX-License-Identifier: Apache-2.0
// The kernels' code, included by one source for each instruction set, which names its table and says how many
// numbers its vectors hold. It must not include anything that has inline functions: the linker would keep one
// copy, perhaps that of an instruction set which the machine does not have.
#include "common/motion/batch/levels.hpp"

namespace sidestep::batch {
namespace {

constexpr std::size_t kWidth = SIDESTEP_VECTOR_WIDTH;
typedef double Vector __attribute__((vector_size(kWidth * sizeof(double))));

constexpr double kInfinity = __builtin_inf();

inline Vector load(const Row& row, std::size_t at) {
  Vector v;
  __builtin_memcpy(&v, &row.lane[at], sizeof v);
  return v;
}
inline void store(Row& row, std::size_t at, const Vector& v) {
  __builtin_memcpy(&row.lane[at], &v, sizeof v);
}
inline Vector all(double value) { return value - Vector{}; }
inline Vector smaller(const Vector& a, const Vector& b) { return a < b ? a : b; }
inline Vector larger(const Vector& a, const Vector& b) { return a > b ? a : b; }
inline Vector root(const Vector& v) {
  Vector result;
  for (std::size_t i = 0; i < kWidth; ++i) result[i] = __builtin_sqrt(v[i]);
  return result;
}

void touching(const Row* xs, const Row* ys, const Row* radii, std::size_t blocks, double x, double y,
              double radius, std::uint8_t* masks) {
  for (std::size_t block = 0; block < blocks; ++block) {
    unsigned mask = 0;
    for (std::size_t at = 0; at < kLanes; at += kWidth) {
      const Vector dx = load(xs[block], at) - x, dy = load(ys[block], at) - y;
      const Vector far = load(radii[block], at) + radius;
      const auto inside = dx * dx + dy * dy <= far * far;
      for (std::size_t i = 0; i < kWidth; ++i) mask |= (inside[i] != 0 ? 1u : 0u) << (at + i);
    }
    masks[block] = static_cast<std::uint8_t>(mask);
  }
}

void sample(const MotionBlock* motions, std::size_t blocks, double step_s, TrackBlock* tracks) {
  const Vector back = all(-step_s), zero = all(0);
  for (std::size_t block = 0; block < blocks; ++block) {
    const MotionBlock& m = motions[block];
    TrackBlock& track = tracks[block];
    for (std::size_t at = 0; at < kLanes; at += kWidth) {
      const Vector start = load(m.start_s, at), first = load(m.first_s, at), second = load(m.second_s, at);
      const Vector x = load(m.x_m, at), y = load(m.y_m, at);
      const Vector vx = load(m.vx_mps, at), vy = load(m.vy_mps, at);
      const Vector hx = load(m.half_ax, at), hy = load(m.half_ay, at);
      const Vector wx = load(m.second_vx, at), wy = load(m.second_vy, at);
      const Vector gx = load(m.second_half_ax, at), gy = load(m.second_half_ay, at);
      for (std::size_t k = 0; k < kSamples; ++k) {
        const Vector into = static_cast<double>(k) * step_s - start;
        // A motion that begins within a step is continued backwards to the step's begin.
        const Vector t = smaller(larger(into, back), first);
        const Vector u = smaller(larger(into - first, zero), second);
        store(track.x_m[k], at, x + t * (vx + t * hx) + u * (wx + u * gx));
        store(track.y_m[k], at, y + t * (vy + t * hy) + u * (wy + u * gy));
      }
    }
  }
}

// On each step the relative motion is near its chord. The chord's distance from the origin is that of an end,
// or, where the foot of the perpendicular lies within, cross^2 / length^2.
void compare(const Track& one, const TrackBlock* lanes, const BoundsBlock* bounds, bool one_bounds,
             std::size_t blocks, double step_s, GapBlock* gaps) {
  const Vector infinite = all(kInfinity), zero = all(0);
  for (std::size_t block = 0; block < blocks; ++block) {
    const BoundsBlock& bound = bounds[one_bounds ? 0 : block];
    const TrackBlock& track = lanes[block];
    for (std::size_t at = 0; at < kLanes; at += kWidth) {
      const Vector start = load(bound.start_s, at);
      const Vector clear_from = load(bound.clear_from, at), blocked_below = load(bound.blocked_below, at);
      Vector clear = load(gaps[block].clear, at), blocked = load(gaps[block].blocked, at);
      Vector x = load(track.x_m[0], at) - one.x_m[0], y = load(track.y_m[0], at) - one.y_m[0];
      Vector distance2 = x * x + y * y;
      Vector counts = start > zero ? infinite : zero;  // infinite: the sample is too early
      blocked = smaller(blocked, distance2 - blocked_below + counts);
      for (std::size_t k = 1; k < kSamples; ++k) {
        const Vector next_x = load(track.x_m[k], at) - one.x_m[k];
        const Vector next_y = load(track.y_m[k], at) - one.y_m[k];
        const Vector next_distance2 = next_x * next_x + next_y * next_y;
        const Vector ex = next_x - x, ey = next_y - y;
        const Vector length2 = ex * ex + ey * ey;
        const Vector along = zero - (x * ex + y * ey);
        const Vector across = x * ey - y * ex;
        const Vector across2 = across * across;
        const Vector within = along * (length2 - along);
        const Vector early = start >= all(static_cast<double>(k) * step_s) ? infinite : zero;
        const Vector next_counts = start > all(static_cast<double>(k) * step_s) ? infinite : zero;
        const Vector chord_clear = within > zero ? across2 - clear_from * length2 : infinite;
        const Vector chord_blocked = within > zero ? across2 - blocked_below * length2 : infinite;
        const Vector ends_clear = smaller(distance2, next_distance2) - clear_from;
        clear = smaller(clear, smaller(chord_clear, ends_clear) + early);
        blocked = smaller(blocked, chord_blocked + counts);
        blocked = smaller(blocked, next_distance2 - blocked_below + next_counts);
        x = next_x;
        y = next_y;
        distance2 = next_distance2;
        counts = next_counts;
      }
      store(gaps[block].clear, at, smaller(clear, distance2 - clear_from));
      store(gaps[block].blocked, at, blocked);
    }
  }
}

void limit(const LimitSettings& s, AccelerationBlock* accelerations, std::size_t blocks) {
  const Vector one = all(1), zero = all(0);
  for (std::size_t block = 0; block < blocks; ++block) {
    AccelerationBlock& a = accelerations[block];
    for (std::size_t at = 0; at < kLanes; at += kWidth) {
      const Vector ahead = load(a.x, at), left = load(a.y, at);
      Vector x = ahead * s.forward_x - left * s.forward_y, y = ahead * s.forward_y + left * s.forward_x;
      const Vector after_x = s.vx_mps + s.seconds * x, after_y = s.vy_mps + s.seconds * y;
      const Vector speed2 = after_x * after_x + after_y * after_y;
      const Vector slower = s.speed_limit_mps / root(speed2);
      const auto too_fast = speed2 > all(s.speed_limit_mps * s.speed_limit_mps);
      x = too_fast ? (after_x * slower - s.vx_mps) * s.inverse_seconds : x;
      y = too_fast ? (after_y * slower - s.vy_mps) * s.inverse_seconds : y;
      const Vector sideways_and_ahead2 = (x * x + y * y) * s.inverse_acceleration2;
      const Vector along = (x * s.vx_mps + y * s.vy_mps) * s.inverse_speed;
      const Vector across = (s.vx_mps * y - s.vy_mps * x) * s.inverse_speed;
      const Vector behind2 =
          along * along * s.inverse_deceleration2 + across * across * s.inverse_acceleration2;
      const Vector along_or_not = s.is_at_rest ? zero : along;
      const Vector effort2 = along_or_not < zero ? behind2 : sideways_and_ahead2;
      const Vector scale = effort2 > one ? one / root(effort2) : one;
      x = x * scale;
      y = y * scale;
      store(a.x, at, x);
      store(a.y, at, y);
      const Vector off_x = x - s.wish_x, off_y = y - s.wish_y;
      store(a.distance2, at, off_x * off_x + off_y * off_y);
    }
  }
}

void stop(const StopSettings& s, const AccelerationBlock* accelerations, std::size_t blocks,
          MotionBlock* motions) {
  constexpr double kNearlyAtRest_mps = 1e-9;
  for (std::size_t block = 0; block < blocks; ++block) {
    MotionBlock& m = motions[block];
    for (std::size_t at = 0; at < kLanes; at += kWidth) {
      const Vector ax = load(accelerations[block].x, at), ay = load(accelerations[block].y, at);
      const Vector vx = s.vx_mps + s.hold_s * ax, vy = s.vy_mps + s.hold_s * ay;
      const Vector speed = larger(root(vx * vx + vy * vy), all(kNearlyAtRest_mps));
      const Vector braking = (-0.5 * s.deceleration_mps2) / speed;
      store(m.start_s, at, all(0));
      store(m.first_s, at, all(s.hold_s));
      store(m.x_m, at, all(s.x_m));
      store(m.y_m, at, all(s.y_m));
      store(m.vx_mps, at, all(s.vx_mps));
      store(m.vy_mps, at, all(s.vy_mps));
      store(m.half_ax, at, 0.5 * ax);
      store(m.half_ay, at, 0.5 * ay);
      store(m.second_s, at, speed * (1 / s.deceleration_mps2));
      store(m.second_vx, at, vx);
      store(m.second_vy, at, vy);
      store(m.second_half_ax, at, vx * braking);
      store(m.second_half_ay, at, vy * braking);
    }
  }
}

std::size_t choose(double x, double y, double spread2, AccelerationBlock* accelerations, const GapBlock* gaps,
                   std::size_t blocks) {
  const Vector infinite = all(kInfinity), zero = all(0);
  Vector nearest = infinite, nearest_block = zero;
  for (std::size_t block = 0; block < blocks; ++block) {
    AccelerationBlock& a = accelerations[block];
    for (std::size_t at = 0; at < kLanes; at += kWidth) {
      const Vector dx = load(a.x, at) - x, dy = load(a.y, at) - y;
      Vector distance2 = load(a.distance2, at);
      distance2 = dx * dx + dy * dy < all(spread2) ? infinite : distance2;
      distance2 = load(gaps[block].blocked, at) < zero ? infinite : distance2;
      store(a.distance2, at, distance2);
      const Vector here = all(static_cast<double>(block * kLanes + at));
      nearest_block = distance2 < nearest ? here : nearest_block;
      nearest = smaller(distance2, nearest);
    }
  }
  double best = kInfinity;
  double best_lane = static_cast<double>(blocks * kLanes);
  for (std::size_t i = 0; i < kWidth; ++i) {
    const double lane = nearest_block[i] + static_cast<double>(i);
    if (nearest[i] < best || (nearest[i] == best && lane < best_lane && best < kInfinity)) {
      best = nearest[i];
      best_lane = lane;
    }
  }
  return static_cast<std::size_t>(best_lane);
}

}  // namespace

const Kernels SIDESTEP_KERNELS{SIDESTEP_LEVEL_NAME, touching, sample, compare, limit, stop, choose};

}  // namespace sidestep::batch
