// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace sidestep {

// Kernels compute a cell's value from the values of its neighbours. `low` is the lowest value among the four
// neighbours, `high` the lowest value of the neighbours on the other axis, and lengths are in cells. Every
// kernel is strictly causal, in floating point too: its result exceeds the values that it uses, and values
// that are not below the result do not influence it. A field that satisfies the kernel everywhere is
// therefore unique, so the order of computation does not matter.

// `kReach` is the distance in cells of the farthest neighbours that a kernel uses.

/// Multiplying a positive number by this rounds to one of the next two greater numbers.
inline constexpr float kNextUp = 1 + 0x1p-23f;

/// The step from the lowest neighbour alone.
inline float straight_step(float low, float cost) { return std::max(low + cost, low * kNextUp); }

/// An interpolated value if both axes contribute; a straight step if the other axis is too high.
inline float interpolated_step(float low, float high, float cost, float interpolated) {
  const float straight = straight_step(low, cost);
  return std::min(straight, std::max(std::min(straight, high * kNextUp), interpolated));
}

/// Distance in steps to the four neighbours: the wavefront NF1 (Latombe 1991, section 7.3.1) with costs.
struct Nf1Kernel {
  static constexpr int kReach = 1;
  static float value(float low, float, float cost) { return straight_step(low, cost); }
};

/// A placeholder for fields in which all values are known exactly.
struct NoKernel {
  static constexpr int kReach = 1;
  static float value(float, float, float) { return std::numeric_limits<float>::infinity(); }
};

/// The kernel "alpha" of E* (Philippsen 2004, EPFL thesis 3146): a linear interpolation. Scaled so that a
/// straight step through a cell costs the cell's cost.
struct AlphaKernel {
  static constexpr int kReach = 1;
  static float value(float low, float high, float cost) {
    if (std::isinf(cost)) return cost;
    return interpolated_step(low, high, cost, low + cost * cost * (1 + high - low) / (1 + cost));
  }
};

/// The level set method's first-order upwind solution of |grad T| = cost (Sethian 1996, fast marching;
/// kernel "LSM" of E*).
struct LsmKernel {
  static constexpr int kReach = 1;
  static float value(float low, float high, float cost) {
    const float gap = std::min(cost, high - low);  // the cost, if high - low is NaN
    return interpolated_step(low, high, cost, low + 0.5f * (gap + std::sqrt(2 * cost * cost - gap * gap)));
  }
};

/// Like LsmKernel, but with second-order differences where the second neighbour on an axis is not above the
/// first (Sethian 1999, Level Set Methods and Fast Marching Methods, section 8.4).
struct SecondOrderLsmKernel {
  static constexpr int kReach = 2;

  /// The lower side of an axis. There the derivative is sqrt(weight) * (value - origin).
  struct Axis {
    float nearest, origin, weight;
  };

  static Axis side(float nearest, float second) {
    if (!(second <= nearest) || std::isinf(nearest)) return {nearest, nearest, 1};
    return {nearest, nearest + (nearest - second) / 3, 2.25f};
  }
  static Axis axis(const Axis& a, const Axis& b) {
    if (a.nearest != b.nearest) return a.nearest < b.nearest ? a : b;
    return a.origin <= b.origin ? a : b;
  }
  static float value(const Axis& x, const Axis& y, float cost) {
    const Axis& low = y.nearest < x.nearest ? y : x;
    const Axis& high = y.nearest < x.nearest ? x : y;
    const float step = low.weight > 1 ? cost * (2.0f / 3) : cost;
    const float straight = std::max(std::min(low.origin + step, low.nearest + cost), low.nearest * kNextUp);
    if (!(high.nearest < straight)) return straight;
    const float sum = low.weight + high.weight, gap = high.origin - low.origin;
    const float square = sum * cost * cost - low.weight * high.weight * gap * gap;
    if (!(square > 0)) return straight;
    const float both = low.origin + (high.weight * gap + std::sqrt(square)) / sum;
    return std::min(straight, std::max(high.nearest * kNextUp, both));
  }
};

}  // namespace sidestep
