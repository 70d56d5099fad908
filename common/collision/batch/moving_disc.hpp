// SPDX-License-Identifier: Apache-2.0
// The query as kernels see it, and its comparison with circles; see vectors.hpp.
#include "common/collision/batch/vectors.hpp"

namespace sidestep::collision {
namespace {

constexpr float kShortest2_m2 = 1e-24f;  // a shorter way is none

/// A disc on its way, in metres from the origin.
struct MovingDisc {
  FourFloats ends_m;  ///< x and y of the place that it comes from, of that it goes to
  float via_x_m, via_y_m, along_x_per_m, along_y_per_m, radius_m;
  float doubt_m2;  ///< how wrong a gap may be that comes out near 0
  bool is_sound;   ///< all is finite, and near enough for single precision
};

/// The bits of a number; those of numbers that are not negative are in the order of the numbers, all others
/// are above.
inline std::uint32_t pattern(float value) {
  std::uint32_t bits;
  __builtin_memcpy(&bits, &value, sizeof bits);
  return bits;
}

inline MovingDisc moving_disc(const BodiesView& bodies, const double* from_m, const double* to_m,
                              double radius_m) {
  const TwoDoubles origin = load_two(bodies.origin_m);
  MovingDisc d;
  d.ends_m = joined(load_two(from_m) - origin, load_two(to_m) - origin);
  const FourFloats way = __builtin_shufflevector(d.ends_m, d.ends_m, 2, 3, 2, 3) - d.ends_m;
  const FourFloats squares = way * way;
  const FourFloats length2 = all<FourFloats>(squares[0] + squares[1]);
  const FourFloats along = way / larger(length2, all<FourFloats>(kShortest2_m2));
  d.via_x_m = way[0];
  d.via_y_m = way[1];
  d.along_x_per_m = along[0];
  d.along_y_per_m = along[1];
  d.radius_m = static_cast<float>(radius_m);
  d.doubt_m2 = bodies.doubt_per_m * d.radius_m + bodies.least_doubt_m2;
  const FourFloats sizes = larger(d.ends_m, -d.ends_m);
  d.is_sound = (not_above(sizes, all<FourFloats>(bodies.limit_m)) == 0xf) &
               (pattern(d.radius_m) <= pattern(bodies.limit_m));
  return d;
}

/// Squared distances from the way less squared reaches: negative where a disc is touched.
template <typename V>
inline V gaps(const V& x_m, const V& y_m, const V& radius_m, const MovingDisc& d) {
  const V dx = x_m - d.ends_m[0], dy = y_m - d.ends_m[1];
  const V along = smaller(larger(dx * d.along_x_per_m + dy * d.along_y_per_m, all<V>(0)), all<V>(1));
  const V ex = dx - along * d.via_x_m, ey = dy - along * d.via_y_m;
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
  const BodyRecord* records = query.bodies.records;
  const FourFloats a = load<FourFloats>(&records[slots[0]].x_m), b = load<FourFloats>(&records[slots[1]].x_m);
  const FourFloats c = load<FourFloats>(&records[slots[2]].x_m), d = load<FourFloats>(&records[slots[3]].x_m);
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

/// The squares of distances from the nearest points of ways along which there is so much.
template <typename V>
inline V squared_distances(const V& off_x_m, const V& off_y_m, const V& along, const V& via_x_m,
                           const V& via_y_m) {
  const V part = smaller(larger(along, all<V>(0)), all<V>(1));
  const V ex = off_x_m - part * via_x_m, ey = off_y_m - part * via_y_m;
  return ex * ex + ey * ey;
}

/// Whether a shape with edges is touched: where the way's ends are near to an edge, an edge's begin is near
/// to the way, they cross, or the way begins within all edges.
inline Answer touches_edges(const BodiesView& bodies, const MovingDisc& d, std::uint32_t first) {
  const EdgeBlock* block = bodies.edges + first;
  const FourFloats error = all<FourFloats>(bodies.error_m);
  bool doubtful = false, inside = true;
  for (std::uint32_t more = block->more;; --more, ++block) {
    const FourFloats way_x = load<FourFloats>(block->via_x_m), way_y = load<FourFloats>(block->via_y_m);
    const FourFloats along_x = load<FourFloats>(block->along_x_per_m),
                     along_y = load<FourFloats>(block->along_y_per_m);
    const FourFloats x = d.ends_m[0] - load<FourFloats>(block->x_m),
                     y = d.ends_m[1] - load<FourFloats>(block->y_m);
    const FourFloats to_x = x + d.via_x_m, to_y = y + d.via_y_m;
    const FourFloats nearest2 =
        smaller(smaller(squared_distances(x, y, x * along_x + y * along_y, way_x, way_y),
                        squared_distances(to_x, to_y, to_x * along_x + to_y * along_y, way_x, way_y)),
                squared_distances(-x, -y, -x * d.along_x_per_m - y * d.along_y_per_m,
                                  all<FourFloats>(d.via_x_m), all<FourFloats>(d.via_y_m)));
    const FourFloats gap = nearest2 - all<FourFloats>(d.radius_m * d.radius_m);
    // On which sides of the edge the way's ends are, and of the way those of the edge, times the other's
    // length.
    const FourFloats turn = d.via_x_m * way_y - d.via_y_m * way_x;
    const FourFloats from = way_x * y - way_y * x, to = from - turn;
    const FourFloats begin = d.via_y_m * x - d.via_x_m * y, end = begin + turn;
    const FourFloats edge_room = error * (larger(way_x, -way_x) + larger(way_y, -way_y));
    const FourFloats way_room =
        error * all<FourFloats>(__builtin_fabsf(d.via_x_m) + __builtin_fabsf(d.via_y_m));
    const FourFloats apart = larger(larger(smaller(from, to) + edge_room, edge_room - larger(from, to)),
                                    larger(smaller(begin, end) + way_room, way_room - larger(begin, end)));
    const unsigned touched = not_above(gap, all<FourFloats>(-d.doubt_m2));
    const unsigned apart_bits = not_above(all<FourFloats>(0), apart);
    if (touched != 0 || apart_bits != 0xf) return Answer::kTouches;
    doubtful |= not_above(gap, all<FourFloats>(d.doubt_m2)) != 0;
    inside &= not_above(from, edge_room) == 0;
    if (more == 0) break;
  }
  return inside ? Answer::kTouches : doubtful ? Answer::kInDoubt : Answer::kClear;
}

/// Whether an obstacle is touched that is not a circle, or a circle touched but for rounding.
inline bool touches_open(const BodiesView& bodies, const MovingDisc& disc, const double* from_m,
                         const double* to_m, double radius_m, std::uint32_t slot) {
  const BodyRecord& record = bodies.records[slot];
  Answer answer = Answer::kInDoubt;
  if (record.radius_m != record.radius_m) answer = touches_edges(bodies, disc, record.edges);
  if (answer == Answer::kInDoubt) [[unlikely]]
    return bodies.touches(bodies.bodies, slot, from_m, to_m, radius_m);
  return answer == Answer::kTouches;
}

/// The same for the open ones of the first four whose bits are set.
template <typename SlotOf>
[[gnu::noinline]] bool touches_any_open(const BodiesView& bodies, const double* from_m, const double* to_m,
                                        double radius_m, std::uint64_t bits, unsigned open, SlotOf slot) {
  const MovingDisc disc = moving_disc(bodies, from_m, to_m, radius_m);
  for (; open != 0; open >>= 1, bits &= bits - 1) {
    if ((open & 1) != 0 && touches_open(bodies, disc, from_m, to_m, radius_m, slot(lowest(bits))))
      return true;
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
    bool touches = (found.surely & wanted) != 0;
    if (const unsigned open = found.open & wanted; open != 0) [[unlikely]]
      touches = touches ||
                touches_any_open(query.bodies, query.from_m, query.to_m, query.radius_m, bits, open, slot);
    bits = bits3 & (bits3 - 1);
    if (bits == 0 || touches) return touches;
  }
}

}  // namespace
}  // namespace sidestep::collision
