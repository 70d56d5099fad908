// SPDX-License-Identifier: Apache-2.0
// Finds and compares; see vectors.hpp. Products may be contracted here, which rounds differently from one
// instruction set to the next: what is decided leaves more room than that.
#include "agents/batch/vectors.hpp"

namespace sidestep::batch {
namespace {

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

/// What the samples so far say of a block's lanes: the smallest squared distance of those that count, and how
/// far chords are from being blocked and from being in doubt.
struct Gaps {
  Vector clear, blocked;
};

// On each step the relative motion is near its chord. The chord's distance from the origin is that of an end,
// or, where the foot of the perpendicular lies within, that to the line, whose square times that of the
// chord's length is (distance * length)^2 - along^2.
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
  Vector nearest = distance2 + early, nearest_used = infinite;
  if (!kSomeStartLate) nearest_used = distance2;
  for (std::size_t k = 1; k < kSamples; ++k) {
    const Vector next_x = load(track.x_m[k], at) - one.x_m[k];
    const Vector next_y = load(track.y_m[k], at) - one.y_m[k];
    const Vector next_distance2 = next_x * next_x + next_y * next_y;
    const Vector ex = next_x - x, ey = next_y - y;
    const Vector length2 = ex * ex + ey * ey;
    const Vector along = x * ex + y * ey;
    const Vector across2 = distance2 * length2 - along * along;
    const Vector within = along * (length2 + along);  // negative: the foot lies within
    Vector chord_clear = within < zero ? across2 - clear_from * length2 : infinite;
    Vector chord_blocked = within < zero ? across2 - blocked_below * length2 : infinite;
    if (kSomeStartLate) {
      const Vector time = all(s.begin_s + static_cast<double>(k) * s.step_s);
      const Vector unused = start >= time ? infinite : zero;
      chord_clear += unused;
      nearest_used = smaller(nearest_used, smaller(distance2, next_distance2) + unused);
      chord_blocked += early;
      early = start > time ? infinite : zero;
      nearest = smaller(nearest, next_distance2 + early);
    } else {
      nearest_used = smaller(nearest_used, next_distance2);
    }
    gaps.clear = smaller(gaps.clear, chord_clear);
    gaps.blocked = smaller(gaps.blocked, chord_blocked);
    x = next_x;
    y = next_y;
    distance2 = next_distance2;
  }
  if (!kSomeStartLate) nearest = nearest_used;
  gaps.clear = smaller(gaps.clear, smaller(nearest_used, distance2) - clear_from);
  gaps.blocked = smaller(gaps.blocked, nearest - blocked_below);
}

void compare(const ComparisonSettings& s, const Track& one, const TrackBlock* lanes, const KeepBlock* keeps,
             bool one_for_all, std::size_t blocks, bool keep_gaps, GapBlock* gaps) {
  const Vector zero = all(0);
  // A function whose second derivative is at most A is within A h^2 / 8 of its chord over a time h.
  const double deviation_s2 = 0.125 * s.step_s * s.step_s;
  for (std::size_t block = 0; block < blocks; ++block) {
    const KeepBlock& keep = keeps[one_for_all ? 0 : block];
    for (std::size_t at = 0; at < kLanes; at += kWidth) {
      const Vector start = load(keep.start_s, at), min_separation_m = load(keep.min_separation_m, at);
      const Vector deviation = (load(keep.acceleration_mps2, at) + s.acceleration_mps2) * deviation_s2;
      const Vector clear_from = larger(min_separation_m + deviation + s.clear_room_m, zero);
      const Vector blocked_below = min_separation_m - deviation - s.blocked_room_m;
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

}  // namespace

const ComparingKernels SIDESTEP_KERNELS{touching, rest, sample, compare, decide};

}  // namespace sidestep::batch
