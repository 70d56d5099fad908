// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/winding_segments.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

constexpr int kMaxRounds = 100;

void append_edge(const GridPoint& from, const GridPoint& to, std::int32_t winding,
                 std::vector<WindingSegment>& segments) {
  // The polygon lies to the left of each of its edges, so it is above an edge that runs rightwards.
  if (from < to) segments.push_back({{from, to}, winding});
  if (to < from) segments.push_back({{to, from}, -winding});
}

/// Merges equal segments, and drops segments that separate nothing.
void merge_equal(std::vector<WindingSegment>& segments) {
  std::sort(segments.begin(), segments.end());
  std::size_t kept = 0;
  for (std::size_t i = 0; i < segments.size();) {
    WindingSegment sum{segments[i].segment, 0};
    for (; i < segments.size() && segments[i].segment == sum.segment; ++i) sum.winding += segments[i].winding;
    if (sum.winding != 0) segments[kept++] = sum;
  }
  segments.resize(kept);
}

bool is_within_bounds(const GridPoint& point, const GridSegment& segment) {
  const auto [low, high] = std::minmax(segment.left.y, segment.right.y);
  return segment.left.x <= point.x && point.x <= segment.right.x && low <= point.y && point.y <= high;
}

bool are_opposite(std::int64_t a, std::int64_t b) { return (a < 0 && b > 0) || (a > 0 && b < 0); }

GridPoint rounded_point(const GridSegment& segment, double fraction) {
  const auto between = [fraction](std::int32_t from, std::int32_t to) {
    return from + static_cast<std::int32_t>(std::lround(fraction * (to - from)));
  };
  return {between(segment.left.x, segment.right.x), between(segment.left.y, segment.right.y)};
}

}  // namespace

void CrossingDivider::append_boundary(std::span<const GridPoint> corners,
                                      std::vector<WindingSegment>& segments) {
  for (std::size_t i = 0; i < corners.size(); ++i)
    append_edge(corners[i], corners[(i + 1) % corners.size()], 1, segments);
}

bool CrossingDivider::divide(std::vector<WindingSegment>& segments) {
  for (int round = 0; round < kMaxRounds; ++round) {
    merge_equal(segments);
    find_cuts(segments);
    if (cuts_.empty()) return true;
    std::sort(cuts_.begin(), cuts_.end());
    divided_.clear();
    auto cut = cuts_.begin();
    for (std::size_t i = 0; i < segments.size(); ++i) {
      const auto& [segment, winding] = segments[i];
      GridPoint from = segment.left;
      for (; cut != cuts_.end() && cut->segment == i; ++cut) {
        append_edge(from, cut->at, winding, divided_);
        from = cut->at;
      }
      append_edge(from, segment.right, winding, divided_);
    }
    std::swap(segments, divided_);
  }
  return false;
}

/// Finds all crossings. Precondition: the segments are sorted by their left ends.
void CrossingDivider::find_cuts(const std::vector<WindingSegment>& segments) {
  cuts_.clear();
  for (std::size_t i = 0; i < segments.size(); ++i)
    for (std::size_t k = i + 1;
         k < segments.size() && segments[k].segment.left.x <= segments[i].segment.right.x; ++k)
      compare(segments, i, k);
}

void CrossingDivider::compare(const std::vector<WindingSegment>& segments, std::size_t i, std::size_t k) {
  const GridSegment &a = segments[i].segment, &b = segments[k].segment;
  if (std::max(a.left.y, a.right.y) < std::min(b.left.y, b.right.y) ||
      std::max(b.left.y, b.right.y) < std::min(a.left.y, a.right.y))
    return;
  const std::int64_t b_left = height_above(a, b.left), b_right = height_above(a, b.right);
  const std::int64_t a_left = height_above(b, a.left), a_right = height_above(b, a.right);
  if (b_left == 0) cut(segments, i, b.left);
  if (b_right == 0) cut(segments, i, b.right);
  if (a_left == 0) cut(segments, k, a.left);
  if (a_right == 0) cut(segments, k, a.right);
  if (!are_opposite(b_left, b_right) || !are_opposite(a_left, a_right)) return;
  const GridPoint at = rounded_point(a, static_cast<double>(a_left) / static_cast<double>(a_left - a_right));
  cut(segments, i, at);
  cut(segments, k, at);
}

/// Cuts a segment at a point, unless the point is an end of the segment or lies beyond its ends.
void CrossingDivider::cut(const std::vector<WindingSegment>& segments, std::size_t i, const GridPoint& at) {
  const GridSegment& segment = segments[i].segment;
  if (at == segment.left || at == segment.right || !is_within_bounds(at, segment)) return;
  const std::int64_t along = std::int64_t{at.x - segment.left.x} * (segment.right.x - segment.left.x) +
                             std::int64_t{at.y - segment.left.y} * (segment.right.y - segment.left.y);
  cuts_.push_back({i, along, at});
}

}  // namespace sidestep
