// SPDX-License-Identifier: Apache-2.0
// The query as kernels see it, and its comparison with circles; see vectors.hpp.
#include "common/collision/batch/vectors.hpp"

namespace sidestep::collision {
namespace {

constexpr float kRounding = 0x1p-24f;
constexpr float kFarthest_m = 1e15f;     // up to which nothing in single precision overflows
constexpr float kShortest2_m2 = 1e-24f;  // a shorter way is none
constexpr unsigned kTogether = 4;        // circles that are compared at a time

/// A disc on its way, in metres from the origin.
struct MovingDisc {
  float x_m, y_m, way_x_m, way_y_m, along_x_per_m, along_y_per_m, radius_m;
  float doubt_m2;  ///< how wrong a gap may be that comes out near 0
  bool is_sound;   ///< all is finite, and near enough for single precision
};

inline float magnitude(float value) { return __builtin_fabsf(value); }
inline float larger_of(float a, float b) { return a > b ? a : b; }

inline MovingDisc moving_disc(const BodiesView& bodies, const double* from_m, const double* to_m,
                              double radius_m) {
  MovingDisc d;
  d.x_m = static_cast<float>(from_m[0] - bodies.origin_x_m);
  d.y_m = static_cast<float>(from_m[1] - bodies.origin_y_m);
  d.way_x_m = static_cast<float>(to_m[0] - from_m[0]);
  d.way_y_m = static_cast<float>(to_m[1] - from_m[1]);
  d.radius_m = static_cast<float>(radius_m);
  const float length2 = d.way_x_m * d.way_x_m + d.way_y_m * d.way_y_m;
  const float per_length2 = length2 > kShortest2_m2 ? 1 / length2 : 0;
  d.along_x_per_m = d.way_x_m * per_length2;
  d.along_y_per_m = d.way_y_m * per_length2;
  const float reach = d.radius_m + bodies.largest_radius_m;
  const float farthest = bodies.farthest_m + magnitude(d.x_m) + magnitude(d.y_m) + magnitude(d.way_x_m) +
                         magnitude(d.way_y_m) + reach;
  // A distance is wrong by less than 16 roundings of what is farthest from the origin: those of the
  // positions, of their difference, of the foot's parameter and of its product. So with a reach R and such an
  // error e the squared distance is wrong by at most 2 R e + e^2 near the reach.
  const float error = 32 * kRounding * farthest;
  d.doubt_m2 = 2 * error * (reach + error);
  d.is_sound = (farthest <= kFarthest_m) & (radius_m >= 0);
  return d;
}

/// Squared distances from the way less squared reaches: negative where a disc is touched.
template <typename V>
inline V gaps(const V& x_m, const V& y_m, const V& radius_m, const MovingDisc& d) {
  const V dx = x_m - d.x_m, dy = y_m - d.y_m;
  const V along = smaller(larger(dx * d.along_x_per_m + dy * d.along_y_per_m, all<V>(0)), all<V>(1));
  const V ex = dx - along * d.way_x_m, ey = dy - along * d.way_y_m;
  const V reach = radius_m + d.radius_m;
  return ex * ex + (ey * ey - reach * reach);
}

/// A query that single precision decides where it can, and the exact comparison elsewhere.
struct Query {
  const BodiesView& bodies;
  MovingDisc disc;
  const double *from_m, *to_m;
  double radius_m;

  bool touches_exactly(std::uint32_t slot) const {
    return slot != bodies.nowhere && bodies.touches(bodies.bodies, slot, from_m, to_m, radius_m);
  }

  /// Whether one of four obstacles is touched, without a branch that depends on it, but where exactness needs
  /// one.
  bool touches(const std::uint32_t* slots) const {
    const FourFloats a = load<FourFloats>(&bodies.circles[slots[0]].x_m);
    const FourFloats b = load<FourFloats>(&bodies.circles[slots[1]].x_m);
    const FourFloats c = load<FourFloats>(&bodies.circles[slots[2]].x_m);
    const FourFloats d = load<FourFloats>(&bodies.circles[slots[3]].x_m);
    const FourFloats ab = __builtin_shufflevector(a, b, 0, 4, 1, 5);
    const FourFloats cd = __builtin_shufflevector(c, d, 0, 4, 1, 5);
    const FourFloats ab_radius = __builtin_shufflevector(a, b, 2, 6, 3, 7);
    const FourFloats cd_radius = __builtin_shufflevector(c, d, 2, 6, 3, 7);
    const FourFloats gap = gaps<FourFloats>(__builtin_shufflevector(ab, cd, 0, 1, 4, 5),
                                            __builtin_shufflevector(ab, cd, 2, 3, 6, 7),
                                            __builtin_shufflevector(ab_radius, cd_radius, 0, 1, 4, 5), disc);
    const unsigned touched = not_above(gap, all<FourFloats>(-disc.doubt_m2));
    // Also where there is no number, which is where there is no circle.
    unsigned open = ~not_above(all<FourFloats>(disc.doubt_m2), gap) & 0xfu & ~touched;
    if (open != 0) [[unlikely]] {
      for (; open != 0; open &= open - 1) {
        if (touches_exactly(slots[__builtin_ctz(open)])) return true;
      }
    }
    return touched != 0;
  }
};

}  // namespace
}  // namespace sidestep::collision
