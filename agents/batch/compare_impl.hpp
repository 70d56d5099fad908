// SPDX-License-Identifier: Apache-2.0
// Comparison kernels for one instruction set; see vectors.hpp. Multiplications and additions may be fused
// here: rounding then differs between instruction sets, but by less than the slack of every decision.
#include "agents/batch/vectors.hpp"

namespace sidestep::batch {
namespace {

void find_touching(const Row* xs, const Row* ys, const Row* radii, std::size_t blocks, double x, double y,
                   double radius, std::uint8_t* masks) {
  for (std::size_t block = 0; block < blocks; ++block) {
    unsigned mask = 0;
    for (std::size_t at = 0; at < kLanes; at += kWidth) {
      const Vector dx = load(xs[block], at) - x, dy = load(ys[block], at) - y;
      const Vector far = load(radii[block], at) + radius;
      mask |= less_equal_bits(dx * dx + dy * dy, far * far) << at;
    }
    masks[block] = static_cast<std::uint8_t>(mask);
  }
}

double find_rest(const MotionBlock* motions, std::size_t blocks, double earliest_s, double latest_s,
                 std::uint8_t* later) {
  Vector latest = broadcast(earliest_s);
  for (std::size_t block = 0; block < blocks; ++block) {
    const MotionBlock& m = motions[block];
    unsigned in_time = 0;
    for (std::size_t at = 0; at < kLanes; at += kWidth) {
      const Vector rest_s = load(m.start_s, at) + load(m.first_s, at) + load(m.second_s, at);
      in_time |= less_equal_bits(rest_s, broadcast(latest_s)) << at;
      latest = max(latest, rest_s <= broadcast(latest_s) ? rest_s : latest);
    }
    later[block] = static_cast<std::uint8_t>(~in_time);
  }
  double result = earliest_s;
  for (std::size_t i = 0; i < kWidth; ++i) result = latest[i] > result ? latest[i] : result;
  return result;
}

void sample(const MotionBlock* motions, std::size_t blocks, double begin_s, double step_s,
            TrackBlock* tracks) {
  const Vector minus_step = broadcast(-step_s), zero = broadcast(0);
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
        const Vector elapsed = begin_s + static_cast<double>(k) * step_s - start;
        // A motion that begins within a step is extrapolated backwards to the start of the step.
        const Vector t = min(max(elapsed, minus_step), first);
        const Vector u = min(max(elapsed - first, zero), second);
        store(track.x_m[k], at, x + t * (vx + t * hx) + u * (wx + u * gx));
        store(track.y_m[k], at, y + t * (vy + t * hy) + u * (wy + u * gy));
      }
    }
  }
}

/// Minimum differences so far between squared distances and the thresholds for "clear" and "blocked". The
/// differences for a chord are multiplied by its squared length, which preserves the signs.
struct Gaps {
  Vector clear, blocked;
};

// Within a step, the relative motion is close to its chord. The chord is nearest to the origin at one of its
// ends or, if the foot of the perpendicular lies within the chord, at this foot. The squared distance of the
// foot, times the squared length of the chord, is (distance * length)^2 - along^2.
template <bool kHasLateStarts>
inline void compare_block(const ComparisonSettings& s, const Track& reference, const TrackBlock& track,
                          std::size_t at, const Vector& start, const Vector& clear_from2,
                          const Vector& blocked_below2, Gaps& gaps) {
  const Vector infinite = broadcast(kInfinity), zero = broadcast(0);
  Vector x = load(track.x_m[0], at) - reference.x_m[0], y = load(track.y_m[0], at) - reference.y_m[0];
  Vector distance2 = x * x + y * y;
  // Infinite in lanes that start after this sample.
  Vector early = zero;
  if (kHasLateStarts) early = start > broadcast(s.begin_s) ? infinite : zero;
  Vector nearest = distance2 + early, nearest_used = infinite;
  if (!kHasLateStarts) nearest_used = distance2;
  for (std::size_t k = 1; k < kSamples; ++k) {
    const Vector next_x = load(track.x_m[k], at) - reference.x_m[k];
    const Vector next_y = load(track.y_m[k], at) - reference.y_m[k];
    const Vector next_distance2 = next_x * next_x + next_y * next_y;
    const Vector ex = next_x - x, ey = next_y - y;
    const Vector length2 = ex * ex + ey * ey;
    const Vector along = x * ex + y * ey;
    const Vector across2 = distance2 * length2 - along * along;
    const Vector within = along * (length2 + along);  // negative if the foot lies within the chord
    Vector chord_clear = within < zero ? across2 - clear_from2 * length2 : infinite;
    Vector chord_blocked = within < zero ? across2 - blocked_below2 * length2 : infinite;
    if (kHasLateStarts) {
      const Vector time = broadcast(s.begin_s + static_cast<double>(k) * s.step_s);
      const Vector too_early = start >= time ? infinite : zero;
      chord_clear += too_early;
      nearest_used = min(nearest_used, min(distance2, next_distance2) + too_early);
      chord_blocked += early;
      early = start > time ? infinite : zero;
      nearest = min(nearest, next_distance2 + early);
    } else {
      nearest_used = min(nearest_used, next_distance2);
    }
    gaps.clear = min(gaps.clear, chord_clear);
    gaps.blocked = min(gaps.blocked, chord_blocked);
    x = next_x;
    y = next_y;
    distance2 = next_distance2;
  }
  if (!kHasLateStarts) nearest = nearest_used;
  gaps.clear = min(gaps.clear, min(nearest_used, distance2) - clear_from2);
  gaps.blocked = min(gaps.blocked, nearest - blocked_below2);
}

void compare(const ComparisonSettings& s, const Track& reference, const TrackBlock* lanes,
             const SeparationBlock* separations, bool is_shared, std::size_t blocks, bool accumulate,
             GapBlock* gaps) {
  const Vector zero = broadcast(0);
  // A function whose second derivative is bounded by A stays within A h^2 / 8 of its chord over a time h.
  const double deviation_s2 = 0.125 * s.step_s * s.step_s;
  for (std::size_t block = 0; block < blocks; ++block) {
    const SeparationBlock& separation = separations[is_shared ? 0 : block];
    for (std::size_t at = 0; at < kLanes; at += kWidth) {
      const Vector start = load(separation.start_s, at),
                   min_separation_m = load(separation.min_separation_m, at);
      const Vector deviation = (load(separation.acceleration_mps2, at) + s.acceleration_mps2) * deviation_s2;
      const Vector clear_from = max(min_separation_m + deviation + s.clear_slack_m, zero);
      const Vector blocked_below = min_separation_m - deviation - s.blocked_slack_m;
      const Vector blocked_below2 = blocked_below > zero ? blocked_below * blocked_below : broadcast(-1);
      Gaps found{broadcast(kInfinity), broadcast(kInfinity)};
      if (accumulate) found = {load(gaps[block].clear, at), load(gaps[block].blocked, at)};
      const bool has_late_starts = less_equal_bits(start, broadcast(s.begin_s)) + 1 != 1u << kWidth;
      if (has_late_starts)
        compare_block<true>(s, reference, lanes[block], at, start, clear_from * clear_from, blocked_below2,
                            found);
      else
        compare_block<false>(s, reference, lanes[block], at, start, clear_from * clear_from, blocked_below2,
                             found);
      store(gaps[block].clear, at, found.clear);
      store(gaps[block].blocked, at, found.blocked);
    }
  }
}

void decide(const GapBlock* gaps, std::size_t blocks, std::uint8_t* clear, std::uint8_t* blocked) {
  for (std::size_t block = 0; block < blocks; ++block) {
    unsigned is_clear = 0, not_blocked = 0;
    for (std::size_t at = 0; at < kLanes; at += kWidth) {
      is_clear |= less_equal_bits(broadcast(0), load(gaps[block].clear, at)) << at;
      not_blocked |= less_equal_bits(broadcast(0), load(gaps[block].blocked, at)) << at;
    }
    clear[block] = static_cast<std::uint8_t>(is_clear);
    blocked[block] = static_cast<std::uint8_t>(~not_blocked);
  }
}

}  // namespace

const ComparisonKernels SIDESTEP_KERNELS{find_touching, find_rest, sample, compare, decide};

}  // namespace sidestep::batch
