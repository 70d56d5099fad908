// SPDX-License-Identifier: Apache-2.0
// The query as kernels see it, and its comparison with circles; see vectors.hpp.
#include "common/collision/batch/vectors.hpp"

namespace sidestep::collision {
namespace {

constexpr float kShortest2_m2 = 1e-24f;  // a shorter way is none

/// A disc on its way, in metres from the origin.
struct MovingDisc {
  FourFloats ends_m;  ///< x and y of the place that it comes from, of that it goes to
  float way_x_m, way_y_m, along_x_per_m, along_y_per_m, radius_m;
  float doubt_m2;  ///< how wrong a gap may be that comes out near 0
  bool is_sound;   ///< all is finite, and near enough for single precision
};

inline MovingDisc moving_disc(const BodiesView& bodies, const double* from_m, const double* to_m,
                              double radius_m) {
  const TwoDoubles origin = load_two(bodies.origin_m);
  MovingDisc d;
  d.ends_m = joined(load_two(from_m) - origin, load_two(to_m) - origin);
  const FourFloats way = __builtin_shufflevector(d.ends_m, d.ends_m, 2, 3, 2, 3) - d.ends_m;
  const FourFloats squares = way * way;
  const FourFloats length2 = all<FourFloats>(squares[0] + squares[1]);
  const FourFloats along = way / larger(length2, all<FourFloats>(kShortest2_m2));
  d.way_x_m = way[0];
  d.way_y_m = way[1];
  d.along_x_per_m = along[0];
  d.along_y_per_m = along[1];
  d.radius_m = static_cast<float>(radius_m);
  // Near the reach, a squared distance with an error e is wrong by at most 2 R e + e^2.
  d.doubt_m2 = 2 * bodies.error_m * (d.radius_m + bodies.largest_radius_m + bodies.error_m);
  const FourFloats sizes = larger(d.ends_m, -d.ends_m);
  d.is_sound = (not_above(sizes, all<FourFloats>(bodies.limit_m)) == 0xf) & (radius_m >= 0) &
               (d.radius_m <= bodies.limit_m);
  return d;
}

/// Squared distances from the way less squared reaches: negative where a disc is touched.
template <typename V>
inline V gaps(const V& x_m, const V& y_m, const V& radius_m, const MovingDisc& d) {
  const V dx = x_m - d.ends_m[0], dy = y_m - d.ends_m[1];
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
};

/// Which of four obstacles are touched, and which single precision cannot tell of.
struct Touched {
  unsigned surely, open;
};

inline Touched touched(const Query& query, const std::uint32_t* slots) {
  const CircleRecord* circles = query.bodies.circles;
  const FourFloats a = load<FourFloats>(&circles[slots[0]].x_m), b = load<FourFloats>(&circles[slots[1]].x_m);
  const FourFloats c = load<FourFloats>(&circles[slots[2]].x_m), d = load<FourFloats>(&circles[slots[3]].x_m);
  const FourFloats ab = __builtin_shufflevector(a, b, 0, 4, 1, 5);
  const FourFloats cd = __builtin_shufflevector(c, d, 0, 4, 1, 5);
  const FourFloats ab_radius = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const FourFloats cd_radius = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  const FourFloats gap = gaps<FourFloats>(
      __builtin_shufflevector(ab, cd, 0, 1, 4, 5), __builtin_shufflevector(ab, cd, 2, 3, 6, 7),
      __builtin_shufflevector(ab_radius, cd_radius, 0, 1, 4, 5), query.disc);
  const unsigned surely = not_above(gap, all<FourFloats>(-query.disc.doubt_m2));
  // Also where there is no number, which is where there is no circle.
  const unsigned open = ~(not_above(all<FourFloats>(query.disc.doubt_m2), gap) | surely);
  return {surely, open};
}

/// Whether one of the obstacles is touched that `slot` says for the bits set, as the exact comparison says.
template <typename SlotOf>
[[gnu::noinline, gnu::cold]] bool touches_exactly(const BodiesView& bodies, const double* from_m,
                                                  const double* to_m, double radius_m, std::uint64_t bits,
                                                  SlotOf slot) {
  for (; bits != 0; bits &= bits - 1) {
    if (bodies.touches(bodies.bodies, slot(lowest(bits)), from_m, to_m, radius_m)) return true;
  }
  return false;
}

/// Whether an obstacle is touched, of those that `slot` says for the bits set. Four at least are compared, so
/// that mostly no branch depends on how many there are.
template <typename SlotOf>
inline bool touches_marked(const Query& query, std::uint64_t bits, const SlotOf& slot) {
  for (;;) {
    const std::uint64_t bits1 = bits & (bits - 1), bits2 = bits1 & (bits1 - 1), bits3 = bits2 & (bits2 - 1);
    const std::uint32_t four[4] = {slot(lowest(bits)), slot(lowest(bits1)), slot(lowest(bits2)),
                                   slot(lowest(bits3))};
    const Touched found = touched(query, four);
    const unsigned wanted = lowest_four(bits);
    const bool touches = (found.surely & wanted) != 0;
    if ((found.open & wanted) != 0) [[unlikely]]
      return touches || touches_exactly(query.bodies, query.from_m, query.to_m, query.radius_m, bits, slot);
    bits = bits3 & (bits3 - 1);
    if (bits == 0 || touches) return touches;
  }
}

}  // namespace
}  // namespace sidestep::collision
