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
/// Bit k: whether lane `at` + k is a.lane <= b.lane.
inline unsigned not_above(const Vector& a, const Vector& b) {
  const auto is = a <= b;
  unsigned bits = 0;
  for (std::size_t i = 0; i < kWidth; ++i) bits |= (is[i] != 0 ? 1u : 0u) << i;
  return bits;
}

void touching(const Row* xs, const Row* ys, const Row* radii, std::size_t blocks, double x, double y,
              double radius, std::uint8_t* masks) {
  for (std::size_t block = 0; block < blocks; ++block) {
    unsigned mask = 0;
    for (std::size_t at = 0; at < kLanes; at += kWidth) {
      const Vector dx = load(xs[block], at) - x, dy = load(ys[block], at) - y;
      const Vector far = load(radii[block], at) + radius;
      mask |= not_above(dx * dx + dy * dy, far * far) << at;
    }
    masks[block] = static_cast<std::uint8_t>(mask);
  }
}

double rest(const MotionBlock* motions, std::size_t blocks, double earliest_s, double latest_s,
            std::uint8_t* later) {
  Vector last = all(earliest_s);
  for (std::size_t block = 0; block < blocks; ++block) {
    const MotionBlock& m = motions[block];
    unsigned in_time = 0;
    for (std::size_t at = 0; at < kLanes; at += kWidth) {
      const Vector rests = load(m.start_s, at) + load(m.first_s, at) + load(m.second_s, at);
      in_time |= not_above(rests, all(latest_s)) << at;
      last = larger(last, rests <= all(latest_s) ? rests : last);
    }
    later[block] = static_cast<std::uint8_t>(~in_time);
  }
  double latest = earliest_s;
  for (std::size_t i = 0; i < kWidth; ++i) latest = last[i] > latest ? last[i] : latest;
  return latest;
}

void sample(const MotionBlock* motions, std::size_t blocks, double begin_s, double step_s,
            TrackBlock* tracks) {
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
        const Vector into = begin_s + static_cast<double>(k) * step_s - start;
        // A motion that begins within a step is continued backwards to the step's begin.
        const Vector t = smaller(larger(into, back), first);
        const Vector u = smaller(larger(into - first, zero), second);
        store(track.x_m[k], at, x + t * (vx + t * hx) + u * (wx + u * gx));
        store(track.y_m[k], at, y + t * (vy + t * hy) + u * (wy + u * gy));
      }
    }
  }
}

/// What the samples so far say of a block's lanes.
struct Gaps {
  Vector clear, blocked;
};

// On each step the relative motion is near its chord. The chord's distance from the origin is that of an end,
// or, where the foot of the perpendicular lies within, cross^2 / length^2.
template <bool kSomeStartLate>
inline void compare_block(const ComparisonSettings& s, const Track& one, const TrackBlock& track,
                          std::size_t at, const Vector& start, const Vector& clear_from,
                          const Vector& blocked_below, Gaps& gaps) {
  const Vector infinite = all(kInfinity), zero = all(0);
  Vector x = load(track.x_m[0], at) - one.x_m[0], y = load(track.y_m[0], at) - one.y_m[0];
  Vector distance2 = x * x + y * y;
  // Infinite where the sample is too early to count.
  Vector early = zero;
  if (kSomeStartLate) early = start > all(s.begin_s) ? infinite : zero;
  gaps.blocked = smaller(gaps.blocked, distance2 - blocked_below + early);
  for (std::size_t k = 1; k < kSamples; ++k) {
    const Vector next_x = load(track.x_m[k], at) - one.x_m[k];
    const Vector next_y = load(track.y_m[k], at) - one.y_m[k];
    const Vector next_distance2 = next_x * next_x + next_y * next_y;
    const Vector ex = next_x - x, ey = next_y - y;
    const Vector length2 = ex * ex + ey * ey;
    const Vector along = x * ex + y * ey;
    const Vector across = x * ey - y * ex;
    const Vector across2 = across * across;
    const Vector within = along * (length2 + along);  // negative: the foot lies within
    Vector chord_clear = within < zero ? across2 - clear_from * length2 : infinite;
    chord_clear = smaller(chord_clear, smaller(distance2, next_distance2) - clear_from);
    Vector chord_blocked = within < zero ? across2 - blocked_below * length2 : infinite;
    Vector end_blocked = next_distance2 - blocked_below;
    if (kSomeStartLate) {
      const Vector time = all(s.begin_s + static_cast<double>(k) * s.step_s);
      chord_clear += start >= time ? infinite : zero;
      chord_blocked += early;
      early = start > time ? infinite : zero;
      end_blocked += early;
    }
    gaps.clear = smaller(gaps.clear, chord_clear);
    gaps.blocked = smaller(gaps.blocked, smaller(chord_blocked, end_blocked));
    x = next_x;
    y = next_y;
    distance2 = next_distance2;
  }
  gaps.clear = smaller(gaps.clear, distance2 - clear_from);
}

void compare(const ComparisonSettings& s, const Track& one, const TrackBlock* lanes, const KeepBlock* keeps,
             bool one_for_all, std::size_t blocks, bool keep_gaps, GapBlock* gaps) {
  const Vector zero = all(0);
  // A function whose second derivative is at most A is within A h^2 / 8 of its chord over a time h.
  const double deviation_s2 = 0.125 * s.step_s * s.step_s;
  for (std::size_t block = 0; block < blocks; ++block) {
    const KeepBlock& keep = keeps[one_for_all ? 0 : block];
    for (std::size_t at = 0; at < kLanes; at += kWidth) {
      const Vector start = load(keep.start_s, at), keep_m = load(keep.keep_m, at);
      const Vector deviation = (load(keep.acceleration_mps2, at) + s.acceleration_mps2) * deviation_s2;
      const Vector clear_from = larger(keep_m + deviation + s.clear_room_m, zero);
      const Vector blocked_below = keep_m - deviation - s.blocked_room_m;
      const Vector blocked_below2 = blocked_below > zero ? blocked_below * blocked_below : all(-1);
      Gaps found{all(kInfinity), all(kInfinity)};
      if (keep_gaps) found = {load(gaps[block].clear, at), load(gaps[block].blocked, at)};
      const bool some_start_late = not_above(start, all(s.begin_s)) + 1 != 1u << kWidth;
      if (some_start_late)
        compare_block<true>(s, one, lanes[block], at, start, clear_from * clear_from, blocked_below2, found);
      else
        compare_block<false>(s, one, lanes[block], at, start, clear_from * clear_from, blocked_below2, found);
      store(gaps[block].clear, at, found.clear);
      store(gaps[block].blocked, at, found.blocked);
    }
  }
}

void decide(const GapBlock* gaps, std::size_t blocks, std::uint8_t* clear, std::uint8_t* blocked) {
  for (std::size_t block = 0; block < blocks; ++block) {
    unsigned is_clear = 0, not_blocked = 0;
    for (std::size_t at = 0; at < kLanes; at += kWidth) {
      is_clear |= not_above(all(0), load(gaps[block].clear, at)) << at;
      not_blocked |= not_above(all(0), load(gaps[block].blocked, at)) << at;
    }
    clear[block] = static_cast<std::uint8_t>(is_clear);
    blocked[block] = static_cast<std::uint8_t>(~not_blocked);
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

const Kernels SIDESTEP_KERNELS{
    SIDESTEP_LEVEL_NAME, touching, rest, sample, compare, decide, limit, stop, choose};

}  // namespace sidestep::batch
