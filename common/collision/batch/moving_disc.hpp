// SPDX-License-Identifier: Apache-2.0
// A query in the form that kernels use, and its comparison with circles and edges; see vectors.hpp for the
// rules of inclusion.
#include "common/collision/batch/vectors.hpp"

namespace sidestep::collision {
namespace {

constexpr float kMinLength2_m2 = 1e-24f;  // a shorter motion counts as being at rest

/// A disc that moves along a segment, relative to the origin.
struct MovingDisc {
  FourFloats ends_m;  ///< start x, start y, end x, end y
  float path_x_m, path_y_m, along_x_per_m, along_y_per_m, radius_m;
  float gap_error_m2;  ///< bound of the error of a gap near 0
  bool is_valid;       ///< all numbers are finite and within the limit of single precision
};

/// The bit pattern of a number. Patterns of non-negative numbers sort like the numbers; those of negative
/// numbers and NaN are larger than the pattern of any finite non-negative number.
inline std::uint32_t bit_pattern(float value) {
  std::uint32_t bits = 0;
  __builtin_memcpy(&bits, &value, sizeof bits);
  return bits;
}

inline MovingDisc moving_disc(const ShapesView& shapes, const double* from_m, const double* to_m,
                              double radius_m) {
  const TwoDoubles origin = load_two(shapes.origin_m);
  MovingDisc d{};
  d.ends_m = joined(load_two(from_m) - origin, load_two(to_m) - origin);
  const FourFloats path = __builtin_shufflevector(d.ends_m, d.ends_m, 2, 3, 2, 3) - d.ends_m;
  const FourFloats squares = path * path;
  const FourFloats length2 = all<FourFloats>(squares[0] + squares[1]);
  const FourFloats along = path / larger(length2, all<FourFloats>(kMinLength2_m2));
  d.path_x_m = path[0];
  d.path_y_m = path[1];
  d.along_x_per_m = along[0];
  d.along_y_per_m = along[1];
  d.radius_m = static_cast<float>(radius_m);
  d.gap_error_m2 = shapes.gap_error_per_m * d.radius_m + shapes.min_gap_error_m2;
  const FourFloats sizes = larger(d.ends_m, -d.ends_m);
  const bool ends_are_valid = not_above(sizes, all<FourFloats>(shapes.limit_m)) == 0xf;
  const bool radius_is_valid = bit_pattern(d.radius_m) <= bit_pattern(shapes.limit_m);
  d.is_valid = ends_are_valid & radius_is_valid;
  return d;
}

/// Gaps between the moving disc and circles: squared distance from the path minus squared sum of radii,
/// negative if they touch.
template <typename V>
inline V gaps(const V& x_m, const V& y_m, const V& radius_m, const MovingDisc& d) {
  const V dx = x_m - d.ends_m[0], dy = y_m - d.ends_m[1];
  const V along = smaller(larger(dx * d.along_x_per_m + dy * d.along_y_per_m, all<V>(0)), all<V>(1));
  const V ex = dx - along * d.path_x_m, ey = dy - along * d.path_y_m;
  const V reach = radius_m + d.radius_m;
  return ex * ex + (ey * ey - reach * reach);
}

/// A query with its numbers in double precision, for the exact comparison where single precision is
/// undecided.
struct Query {
  const ShapesView& shapes;
  MovingDisc disc;
  const double *from_m, *to_m;
  double radius_m;
};

/// Two bit masks for four obstacles: those that are touched, and those that single precision cannot decide.
struct Touched {
  unsigned surely, undecided;
};

inline Touched touched(const Query& query, const std::uint32_t* slots) {
  const ShapeRecord* records = query.shapes.records;
  const FourFloats a = load<FourFloats>(&records[slots[0]].x_m), b = load<FourFloats>(&records[slots[1]].x_m);
  const FourFloats c = load<FourFloats>(&records[slots[2]].x_m), d = load<FourFloats>(&records[slots[3]].x_m);
  const FourFloats ab = __builtin_shufflevector(a, b, 0, 4, 1, 5);
  const FourFloats cd = __builtin_shufflevector(c, d, 0, 4, 1, 5);
  const FourFloats ab_radius = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const FourFloats cd_radius = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  const FourFloats gap = gaps<FourFloats>(
      __builtin_shufflevector(ab, cd, 0, 1, 4, 5), __builtin_shufflevector(ab, cd, 2, 3, 6, 7),
      __builtin_shufflevector(ab_radius, cd_radius, 0, 1, 4, 5), query.disc);
  const unsigned surely = not_above(gap, all<FourFloats>(-query.disc.gap_error_m2));
  // Includes NaN gaps, which mark shapes other than circles.
  const unsigned undecided = ~(not_above(all<FourFloats>(query.disc.gap_error_m2), gap) | surely);
  return {surely, undecided};
}

/// Squared distances of points from segments. `off` is the point's offset from the segment's start, `along`
/// its projection onto the segment as a fraction of the length.
template <typename V>
inline V squared_distances(const V& off_x_m, const V& off_y_m, const V& along, const V& segment_x_m,
                           const V& segment_y_m) {
  const V fraction = smaller(larger(along, all<V>(0)), all<V>(1));
  const V ex = off_x_m - fraction * segment_x_m, ey = off_y_m - fraction * segment_y_m;
  return ex * ex + ey * ey;
}

/// Whether a shape with edges is touched: an end of the path is near an edge, an edge's start point is near
/// the path, the path crosses an edge, or the path starts inside all edges.
inline SweepResult touches_edges(const ShapesView& shapes, const MovingDisc& d, std::uint32_t first) {
  const EdgeBlock* block = shapes.edges + first;
  const FourFloats error = all<FourFloats>(shapes.error_m);
  bool undecided = false, inside = true;
  for (std::uint32_t following = block->following;; --following, ++block) {
    const FourFloats edge_x = load<FourFloats>(block->edge_x_m), edge_y = load<FourFloats>(block->edge_y_m);
    const FourFloats along_x = load<FourFloats>(block->along_x_per_m),
                     along_y = load<FourFloats>(block->along_y_per_m);
    const FourFloats x = d.ends_m[0] - load<FourFloats>(block->x_m),
                     y = d.ends_m[1] - load<FourFloats>(block->y_m);
    const FourFloats to_x = x + d.path_x_m, to_y = y + d.path_y_m;
    const FourFloats nearest2 =
        smaller(smaller(squared_distances(x, y, x * along_x + y * along_y, edge_x, edge_y),
                        squared_distances(to_x, to_y, to_x * along_x + to_y * along_y, edge_x, edge_y)),
                squared_distances(-x, -y, -x * d.along_x_per_m - y * d.along_y_per_m,
                                  all<FourFloats>(d.path_x_m), all<FourFloats>(d.path_y_m)));
    const FourFloats gap = nearest2 - all<FourFloats>(d.radius_m * d.radius_m);
    // Signed distances of the path's ends from the edge, times the edge's length; and of the edge's ends from
    // the path, times the path's length.
    const FourFloats turn = d.path_x_m * edge_y - d.path_y_m * edge_x;
    const FourFloats from = edge_x * y - edge_y * x, to = from - turn;
    const FourFloats begin = d.path_y_m * x - d.path_x_m * y, end = begin + turn;
    const FourFloats edge_error = error * (larger(edge_x, -edge_x) + larger(edge_y, -edge_y));
    const FourFloats path_error =
        error * all<FourFloats>(__builtin_fabsf(d.path_x_m) + __builtin_fabsf(d.path_y_m));
    const FourFloats apart =
        larger(larger(smaller(from, to) + edge_error, edge_error - larger(from, to)),
               larger(smaller(begin, end) + path_error, path_error - larger(begin, end)));
    const unsigned touched = not_above(gap, all<FourFloats>(-d.gap_error_m2));
    const unsigned apart_bits = not_above(all<FourFloats>(0), apart);
    if (touched != 0 || apart_bits != 0xf) return SweepResult::kTouches;
    undecided |= not_above(gap, all<FourFloats>(d.gap_error_m2)) != 0;
    inside &= not_above(from, edge_error) == 0;
    if (following == 0) break;
  }
  return inside ? SweepResult::kTouches : undecided ? SweepResult::kUndecided : SweepResult::kClear;
}

/// Resolves an undecided obstacle: a shape with edges, or a circle in contact within rounding error.
inline bool touches_undecided(const ShapesView& shapes, const MovingDisc& disc, const double* from_m,
                              const double* to_m, double radius_m, std::uint32_t slot) {
  const ShapeRecord& record = shapes.records[slot];
  SweepResult result = SweepResult::kUndecided;
  if (record.radius_m != record.radius_m) result = touches_edges(shapes, disc, record.edges);
  if (result == SweepResult::kUndecided) [[unlikely]]
    return shapes.touches(shapes.store, slot, from_m, to_m, radius_m);
  return result == SweepResult::kTouches;
}

/// Whether any undecided obstacle among the first four set bits is touched.
template <typename SlotOf>
[[gnu::noinline]] bool touches_any_undecided(const ShapesView& shapes, const double* from_m,
                                             const double* to_m, double radius_m, std::uint64_t bits,
                                             unsigned undecided, SlotOf slot) {
  const MovingDisc disc = moving_disc(shapes, from_m, to_m, radius_m);
  for (; undecided != 0; undecided >>= 1, bits &= bits - 1) {
    if ((undecided & 1) != 0 && touches_undecided(shapes, disc, from_m, to_m, radius_m, slot(lowest(bits))))
      return true;
  }
  return false;
}

/// Whether any obstacle marked by a set bit is touched; `slot` maps bits to slots. Compares in groups of
/// four, so that usually no branch depends on the number of candidates.
template <typename SlotOf>
inline bool touches_marked(const Query& query, std::uint64_t bits, const SlotOf& slot) {
  for (;;) {
    const std::uint64_t bits1 = bits & (bits - 1), bits2 = bits1 & (bits1 - 1), bits3 = bits2 & (bits2 - 1);
    const std::uint32_t four[4] = {slot(lowest(bits)), slot(lowest(bits1)), slot(lowest(bits2)),
                                   slot(lowest(bits3))};
    const Touched found = touched(query, four);
    const unsigned wanted = lowest_bits_mask(bits);
    bool touches = (found.surely & wanted) != 0;
    if (const unsigned undecided = found.undecided & wanted; undecided != 0) [[unlikely]]
      touches = touches || touches_any_undecided(query.shapes, query.from_m, query.to_m, query.radius_m, bits,
                                                 undecided, slot);
    bits = bits3 & (bits3 - 1);
    if (bits == 0 || touches) return touches;
  }
}

}  // namespace
}  // namespace sidestep::collision
