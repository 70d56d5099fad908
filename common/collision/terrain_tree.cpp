// SPDX-License-Identifier: Apache-2.0
#include "common/collision/terrain_tree.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace sidestep {
namespace {

constexpr std::uint32_t kTrianglesOfLeaf = 4;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

void require(bool is_right, const char* what) {
  if (!is_right) throw std::invalid_argument(what);
}

std::vector<Vec3> points_of(const HeightField& field) {
  require(field.columns >= 2 && field.rows >= 2, "a height field has no square");
  require(field.heights_m.size() == field.columns * field.rows,
          "a height field has not as many heights as points");
  require(field.spacing_m > 0, "a height field's spacing is not above 0");
  std::vector<Vec3> points;
  points.reserve(field.heights_m.size());
  for (std::size_t row = 0; row < field.rows; ++row) {
    for (std::size_t column = 0; column < field.columns; ++column) {
      const Vec2 place =
          field.corner_m + field.spacing_m * Vec2(static_cast<double>(column), static_cast<double>(row));
      points.emplace_back(place.x(), place.y(), field.heights_m[row * field.columns + column]);
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

/// A query's segment.
struct TerrainTree::Line {
  Vec3 from_m, path_m;

  Line(const Vec3& from, const Vec3& to) : from_m(from), path_m(to - from) {
    require(from.allFinite() && to.allFinite(), "a place over terrain is not finite");
  }
  Vec3 to_m() const { return from_m + path_m; }
  Vec3 at(double part) const { return from_m + part * path_m; }

  /// The parts of the line between which it is over a rectangle; none where the first is above the second.
  std::pair<double, double> over(const Node& node) const {
    double begin = 0, end = 1;
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      const double low = node.min_m[axis] - from_m[axis], high = node.max_m[axis] - from_m[axis];
      if (path_m[axis] == 0) {
        if (low > 0 || high < 0) return {1, 0};
        continue;
      }
      const double a = low / path_m[axis], b = high / path_m[axis];
      begin = std::max(begin, std::min(a, b));
      end = std::min(end, std::max(a, b));
    }
    return {begin, end};
  }

  /// How far outside of the box the line is at a part of it, along each axis.
  Vec3 outside(const Node& node, double part) const {
    const Vec3 p = at(part);
    return p - p.cwiseMax(node.min_m).cwiseMin(node.max_m);
  }

  /// The square of the distance from a box, exact: its derivative grows, and is linear between the parts
  /// where the line meets a plane of the box.
  double squared_distance_from(const Node& node) const {
    const auto slope = [&](double part) { return path_m.dot(outside(node, part)); };
    double begin = 0, end = 1, slope_begin = slope(0), slope_end = slope(1);
    if (slope_begin >= 0) return outside(node, 0).squaredNorm();
    if (slope_end <= 0) return outside(node, 1).squaredNorm();
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      for (const double plane : {node.min_m[axis], node.max_m[axis]}) {
        const double part = path_m[axis] != 0 ? (plane - from_m[axis]) / path_m[axis] : begin;
        if (!(part > begin && part < end)) continue;
        const double slope_here = slope(part);
        (slope_here < 0 ? begin : end) = part;
        (slope_here < 0 ? slope_begin : slope_end) = slope_here;
      }
    }
    const double part = begin + (end - begin) * slope_begin / (slope_begin - slope_end);
    return outside(node, part).squaredNorm();
  }
};

/// The smallest height of the line's points over a triangle; what is over none of it is infinitely high, as
/// is all over a triangle that is upright.
double TerrainTree::height_over(const Line& line, const Triangle& t) {
  const std::array<Vec2, 3> corners{t.a_m.head<2>(), t.b_m.head<2>(), t.c_m.head<2>()};
  const double area = cross(corners[1] - corners[0], corners[2] - corners[0]);
  if (area == 0) return kInfinite;
  // The weights of the corners at the line's ends. Rounding must not leave gaps between triangles.
  constexpr double kLeast = -1e-9;
  std::array<double, 3> at_begin{}, at_end{};
  double begin = 0, end = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec2 &next = corners[(i + 1) % 3], &last = corners[(i + 2) % 3];
    at_begin[i] = cross(last - next, line.from_m.head<2>() - next) / area;
    at_end[i] = cross(last - next, line.to_m().head<2>() - next) / area;
    const double in_begin = at_begin[i] - kLeast, in_end = at_end[i] - kLeast;
    if (in_begin < 0 && in_end < 0) return kInfinite;
    if (in_begin < 0) begin = std::max(begin, in_begin / (in_begin - in_end));
    if (in_end < 0) end = std::min(end, in_begin / (in_begin - in_end));
  }
  if (begin > end) return kInfinite;
  const auto height = [&](double part) {
    double ground = 0;
    for (std::size_t i = 0; i < 3; ++i)
      ground += (at_begin[i] + part * (at_end[i] - at_begin[i])) * (i == 0   ? t.a_m
                                                                    : i == 1 ? t.b_m
                                                                             : t.c_m)
                                                                       .z();
    return line.at(part).z() - ground;
  };
  return std::min(height(begin), height(end));
}

TerrainTree::TerrainTree(const HeightField& field) : TerrainTree(points_of(field), triangles_of(field)) {}

TerrainTree::TerrainTree(std::vector<Vec3> points, std::vector<Corners> triangles)
    : points_m_(std::move(points)), triangles_(std::move(triangles)) {
  require(!triangles_.empty(), "a terrain has no triangles");
  for (const Vec3& point : points_m_) require(point.allFinite(), "a terrain's point is not finite");
  std::vector<Vec3> middles;
  for (const Corners& corners : triangles_) {
    for (const std::uint32_t corner : corners)
      require(corner < points_m_.size(), "a terrain's triangle has no such corner");
    middles.push_back((points_m_[corners[0]] + points_m_[corners[1]] + points_m_[corners[2]]) / 3);
  }
  std::vector<std::uint32_t> order(triangles_.size());
  std::iota(order.begin(), order.end(), 0u);
  build(0, static_cast<std::uint32_t>(order.size()), middles, order);
  std::vector<Corners> ordered;
  for (const std::uint32_t at : order) ordered.push_back(triangles_[at]);
  triangles_ = std::move(ordered);
}

void TerrainTree::build(std::uint32_t first, std::uint32_t count, std::vector<Vec3>& middles,
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
  if (count <= kTrianglesOfLeaf) return;
  Eigen::Index axis = 0;
  (node.max_m - node.min_m).maxCoeff(&axis);
  const auto begin = order.begin() + first;
  std::nth_element(begin, begin + count / 2, begin + count,
                   [&](std::uint32_t a, std::uint32_t b) { return middles[a][axis] < middles[b][axis]; });
  build(first, count / 2, middles, order);
  nodes_[id].second_child = static_cast<std::uint32_t>(nodes_.size());
  build(first + count / 2, count - count / 2, middles, order);
}

Triangle TerrainTree::triangle(std::uint32_t at) const {
  const Corners& corners = triangles_[at];
  return {points_m_[corners[0]], points_m_[corners[1]], points_m_[corners[2]]};
}

double TerrainTree::distance_m(const Vec3& from, const Vec3& to) const {
  double nearest2 = kInfinite;
  find_nearest(0, Line(from, to), 0, nearest2);
  return std::sqrt(nearest2);
}

bool TerrainTree::touches(const Vec3& from, const Vec3& to, double radius) const {
  require(radius >= 0 && std::isfinite(radius), "a ball's radius is not finite, or negative");
  const Line line(from, to);
  double height = kInfinite;
  find_lowest(0, Line(from, from), height);
  if (height <= 0) return true;
  // Boxes farther than this do not matter.
  double nearest2 = std::nextafter(radius * radius, kInfinite);
  find_nearest(0, line, radius * radius, nearest2);
  return nearest2 <= radius * radius;
}

void TerrainTree::find_nearest(std::uint32_t id, const Line& line, double enough2, double& nearest2) const {
  const Node& node = nodes_[id];
  if (node.second_child == 0) {
    for (std::uint32_t i = node.first; i < node.first + node.count && nearest2 > enough2; ++i)
      nearest2 = std::min(nearest2, squared_distance(line.from_m, line.to_m(), triangle(i)));
    return;
  }
  std::uint32_t near = id + 1, far = node.second_child;
  double near2 = line.squared_distance_from(nodes_[near]), far2 = line.squared_distance_from(nodes_[far]);
  if (far2 < near2) {
    std::swap(near, far);
    std::swap(near2, far2);
  }
  if (near2 < nearest2 && nearest2 > enough2) find_nearest(near, line, enough2, nearest2);
  if (far2 < nearest2 && nearest2 > enough2) find_nearest(far, line, enough2, nearest2);
}

double TerrainTree::height_m(const Vec3& from, const Vec3& to) const {
  double lowest = kInfinite;
  find_lowest(0, Line(from, to), lowest);
  return lowest;
}

void TerrainTree::find_lowest(std::uint32_t id, const Line& line, double& lowest) const {
  const Node& node = nodes_[id];
  const auto [begin, end] = line.over(node);
  if (begin > end || std::min(line.at(begin).z(), line.at(end).z()) - node.max_m.z() >= lowest) return;
  if (node.second_child != 0) {
    find_lowest(id + 1, line, lowest);
    find_lowest(node.second_child, line, lowest);
    return;
  }
  for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
    lowest = std::min(lowest, height_over(line, triangle(i)));
}

}  // namespace sidestep
