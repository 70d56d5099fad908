// SPDX-License-Identifier: Apache-2.0
#include "common/collision/terrain_tree.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace sidestep {
namespace {

constexpr std::uint32_t kMaxLeafTriangles = 4;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

void require(bool is_right, const char* what) {
  if (!is_right) throw std::invalid_argument(what);
}

std::vector<Vec3> points_of(const HeightField& field) {
  require(field.columns >= 2 && field.rows >= 2, "a height field needs at least two columns and two rows");
  require(field.heights_m.size() == field.columns * field.rows,
          "a height field needs columns * rows heights");
  require(field.spacing_m > 0, "a height field's spacing has to be > 0");
  std::vector<Vec3> points;
  points.reserve(field.heights_m.size());
  for (std::size_t row = 0; row < field.rows; ++row) {
    for (std::size_t column = 0; column < field.columns; ++column) {
      const Vec2 position =
          field.corner_m + field.spacing_m * Vec2(static_cast<double>(column), static_cast<double>(row));
      points.emplace_back(position.x(), position.y(), field.heights_m[row * field.columns + column]);
    }
  }
  return points;
}

std::vector<TerrainTree::Corners> triangles_of(const HeightField& field) {
  std::vector<TerrainTree::Corners> triangles;
  const auto columns = static_cast<std::uint32_t>(field.columns);
  for (std::uint32_t row = 0; row + 1 < field.rows; ++row) {
    for (std::uint32_t column = 0; column + 1 < columns; ++column) {
      const std::uint32_t at = row * columns + column;
      triangles.push_back({at, at + 1, at + columns});
      triangles.push_back({at + 1, at + columns + 1, at + columns});
    }
  }
  return triangles;
}

}  // namespace

/// The segment of a query.
struct TerrainTree::QuerySegment {
  Vec3 from_m, displacement_m;

  QuerySegment(const Vec3& from, const Vec3& to) : from_m(from), displacement_m(to - from) {
    require(from.allFinite() && to.allFinite(), "the position of a terrain query is not finite");
  }
  Vec3 to_m() const { return from_m + displacement_m; }
  Vec3 at(double fraction) const { return from_m + fraction * displacement_m; }

  /// The interval of the segment, as fractions of its length, that lies above or below a node's rectangle in
  /// x and y. Empty if its start exceeds its end.
  std::pair<double, double> interval_over(const Node& node) const {
    double begin = 0, end = 1;
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      const double low = node.min_m[axis] - from_m[axis], high = node.max_m[axis] - from_m[axis];
      if (displacement_m[axis] == 0) {
        if (low > 0 || high < 0) return {1, 0};
        continue;
      }
      const double a = low / displacement_m[axis], b = high / displacement_m[axis];
      begin = std::max(begin, std::min(a, b));
      end = std::min(end, std::max(a, b));
    }
    return {begin, end};
  }

  /// The offset along each axis from a node's box to the point at a fraction of the segment.
  Vec3 offset_outside(const Node& node, double fraction) const {
    const Vec3 p = at(fraction);
    return p - p.cwiseMax(node.min_m).cwiseMin(node.max_m);
  }

  /// The exact squared distance of the segment from a node's box. Its derivative increases along the segment,
  /// and is linear between the points where the segment meets a plane of the box.
  double squared_distance_to(const Node& node) const {
    const auto slope = [&](double fraction) { return displacement_m.dot(offset_outside(node, fraction)); };
    double begin = 0, end = 1, slope_begin = slope(0), slope_end = slope(1);
    if (slope_begin >= 0) return offset_outside(node, 0).squaredNorm();
    if (slope_end <= 0) return offset_outside(node, 1).squaredNorm();
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      for (const double plane : {node.min_m[axis], node.max_m[axis]}) {
        const double fraction =
            displacement_m[axis] != 0 ? (plane - from_m[axis]) / displacement_m[axis] : begin;
        if (!(fraction > begin && fraction < end)) continue;
        const double slope_here = slope(fraction);
        (slope_here < 0 ? begin : end) = fraction;
        (slope_here < 0 ? slope_begin : slope_end) = slope_here;
      }
    }
    const double fraction = begin + (end - begin) * slope_begin / (slope_begin - slope_end);
    return offset_outside(node, fraction).squaredNorm();
  }
};

/// The minimum height of the segment above a triangle. Infinite if no point of it lies above or below the
/// triangle, or if the triangle is vertical.
double TerrainTree::height_above(const QuerySegment& segment, const Triangle& t) {
  const std::array<Vec2, 3> corners{t.a_m.head<2>(), t.b_m.head<2>(), t.c_m.head<2>()};
  const double area = cross(corners[1] - corners[0], corners[2] - corners[0]);
  if (area == 0) return kInfinite;
  // Barycentric coordinates of the segment's ends. The tolerance closes gaps between triangles that are due
  // to rounding.
  constexpr double kMinWeight = -1e-9;
  std::array<double, 3> at_begin{}, at_end{};
  double begin = 0, end = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec2 &next = corners[(i + 1) % 3], &last = corners[(i + 2) % 3];
    at_begin[i] = cross(last - next, segment.from_m.head<2>() - next) / area;
    at_end[i] = cross(last - next, segment.to_m().head<2>() - next) / area;
    const double in_begin = at_begin[i] - kMinWeight, in_end = at_end[i] - kMinWeight;
    if (in_begin < 0 && in_end < 0) return kInfinite;
    if (in_begin < 0) begin = std::max(begin, in_begin / (in_begin - in_end));
    if (in_end < 0) end = std::min(end, in_begin / (in_begin - in_end));
  }
  if (begin > end) return kInfinite;
  const auto height = [&](double fraction) {
    double ground = 0;
    for (std::size_t i = 0; i < 3; ++i)
      ground += (at_begin[i] + fraction * (at_end[i] - at_begin[i])) * (i == 0   ? t.a_m
                                                                        : i == 1 ? t.b_m
                                                                                 : t.c_m)
                                                                           .z();
    return segment.at(fraction).z() - ground;
  };
  return std::min(height(begin), height(end));
}

TerrainTree::TerrainTree(const HeightField& field) : TerrainTree(points_of(field), triangles_of(field)) {}

TerrainTree::TerrainTree(std::vector<Vec3> points, std::vector<Corners> triangles)
    : points_m_(std::move(points)), triangles_(std::move(triangles)) {
  require(!triangles_.empty(), "a terrain has no triangles");
  for (const Vec3& point : points_m_) require(point.allFinite(), "a terrain's point is not finite");
  std::vector<Vec3> centroids;
  for (const Corners& corners : triangles_) {
    for (const std::uint32_t corner : corners)
      require(corner < points_m_.size(), "a terrain triangle refers to a corner that does not exist");
    centroids.push_back((points_m_[corners[0]] + points_m_[corners[1]] + points_m_[corners[2]]) / 3);
  }
  std::vector<std::uint32_t> order(triangles_.size());
  std::iota(order.begin(), order.end(), 0u);
  build(0, static_cast<std::uint32_t>(order.size()), centroids, order);
  std::vector<Corners> ordered;
  ordered.reserve(order.size());
  for (const std::uint32_t at : order) ordered.push_back(triangles_[at]);
  triangles_ = std::move(ordered);
}

void TerrainTree::build(std::uint32_t first, std::uint32_t count, std::vector<Vec3>& centroids,
                        std::vector<std::uint32_t>& order) {
  const std::size_t id = nodes_.size();
  Node node{Vec3::Constant(kInfinite), Vec3::Constant(-kInfinite), first, count, 0};
  for (std::uint32_t i = first; i < first + count; ++i) {
    for (const std::uint32_t corner : triangles_[order[i]]) {
      node.min_m = node.min_m.cwiseMin(points_m_[corner]);
      node.max_m = node.max_m.cwiseMax(points_m_[corner]);
    }
  }
  nodes_.push_back(node);
  if (count <= kMaxLeafTriangles) return;
  Eigen::Index axis = 0;
  (node.max_m - node.min_m).maxCoeff(&axis);
  const auto begin = order.begin() + first;
  std::nth_element(begin, begin + count / 2, begin + count,
                   [&](std::uint32_t a, std::uint32_t b) { return centroids[a][axis] < centroids[b][axis]; });
  build(first, count / 2, centroids, order);
  nodes_[id].second_child = static_cast<std::uint32_t>(nodes_.size());
  build(first + count / 2, count - count / 2, centroids, order);
}

Triangle TerrainTree::triangle(std::uint32_t at) const {
  const Corners& corners = triangles_[at];
  return {points_m_[corners[0]], points_m_[corners[1]], points_m_[corners[2]]};
}

double TerrainTree::distance_m(const Vec3& from, const Vec3& to) const {
  double nearest2 = kInfinite;
  find_nearest(0, QuerySegment(from, to), 0, nearest2);
  return std::sqrt(nearest2);
}

bool TerrainTree::touches(const Vec3& from, const Vec3& to, double radius) const {
  require(radius >= 0 && std::isfinite(radius), "a ball's radius is not finite, or negative");
  const QuerySegment segment(from, to);
  double height = kInfinite;
  find_min_height(0, QuerySegment(from, from), height);
  if (height <= 0) return true;
  // Boxes farther away than the radius are skipped by the search.
  double nearest2 = std::nextafter(radius * radius, kInfinite);
  find_nearest(0, segment, radius * radius, nearest2);
  return nearest2 <= radius * radius;
}

void TerrainTree::find_nearest(std::uint32_t id, const QuerySegment& segment, double sufficient2,
                               double& nearest2) const {
  const Node& node = nodes_[id];
  if (node.second_child == 0) {
    for (std::uint32_t i = node.first; i < node.first + node.count && nearest2 > sufficient2; ++i)
      nearest2 = std::min(nearest2, squared_distance(segment.from_m, segment.to_m(), triangle(i)));
    return;
  }
  std::uint32_t near = id + 1, far = node.second_child;
  double near2 = segment.squared_distance_to(nodes_[near]), far2 = segment.squared_distance_to(nodes_[far]);
  if (far2 < near2) {
    std::swap(near, far);
    std::swap(near2, far2);
  }
  if (near2 < nearest2 && nearest2 > sufficient2) find_nearest(near, segment, sufficient2, nearest2);
  if (far2 < nearest2 && nearest2 > sufficient2) find_nearest(far, segment, sufficient2, nearest2);
}

double TerrainTree::min_height_m(const Vec3& from, const Vec3& to) const {
  double min_height = kInfinite;
  find_min_height(0, QuerySegment(from, to), min_height);
  return min_height;
}

void TerrainTree::find_min_height(std::uint32_t id, const QuerySegment& segment, double& min_height) const {
  const Node& node = nodes_[id];
  const auto [begin, end] = segment.interval_over(node);
  if (begin > end || std::min(segment.at(begin).z(), segment.at(end).z()) - node.max_m.z() >= min_height)
    return;
  if (node.second_child != 0) {
    find_min_height(id + 1, segment, min_height);
    find_min_height(node.second_child, segment, min_height);
    return;
  }
  for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
    min_height = std::min(min_height, height_above(segment, triangle(i)));
}

}  // namespace sidestep
