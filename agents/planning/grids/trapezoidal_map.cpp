// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/trapezoidal_map.hpp"

#include <numeric>
#include <stdexcept>

namespace sidestep {
namespace {

constexpr std::size_t kSameBottom = 0, kSameTop = 1;

[[noreturn]] void throw_crossing() {
  throw std::invalid_argument("segments of a trapezoidal map must not cross or overlap");
}

}  // namespace

void TrapezoidalMap::build(std::span<const GridSegment> segments, const GridPoint& half, Rng& rng) {
  if (half.x > kMaxGridCoordinate || half.y > kMaxGridCoordinate)
    throw std::invalid_argument("the box of a trapezoidal map exceeds 2^29 units");
  const auto is_inside = [&](const GridPoint& p) {
    return -half.x < p.x && p.x < half.x && -half.y < p.y && p.y < half.y;
  };
  for (const GridSegment& segment : segments) {
    if (!(segment.left < segment.right))
      throw std::invalid_argument("the left end of a segment must be left of its right end");
    if (!is_inside(segment.left) || !is_inside(segment.right))
      throw std::invalid_argument("a segment of a trapezoidal map must be within the map's box");
  }
  segments_.assign(segments.begin(), segments.end());
  segments_.push_back({{-half.x, -half.y}, {half.x, -half.y}});
  segments_.push_back({{-half.x, half.y}, {half.x, half.y}});
  trapezoids_.clear();
  nodes_.clear();
  free_trapezoids_.clear();
  new_trapezoid(box_bottom(), box_top(), {-half.x, -half.y}, half);
  order_.resize(segments.size());
  std::iota(order_.begin(), order_.end(), 0u);
  rng.shuffle(order_);
  for (const Index segment : order_) insert(segment);
}

TrapezoidalMap::Location TrapezoidalMap::locate(const GridPoint& point) const {
  std::size_t steps = 0;
  Index at = 0;
  for (; nodes_[at].kind != Kind::kTrapezoid; ++steps) {
    const Node& node = nodes_[at];
    const GridSegment& segment = segments_[node.index];
    const bool is_second = node.kind == Kind::kLeftEnd    ? point >= segment.left
                           : node.kind == Kind::kRightEnd ? point >= segment.right
                                                          : height_above(segment, point) >= 0;
    at = node.children[is_second ? 1 : 0];
  }
  return {nodes_[at].index, steps};
}

TrapezoidalMap::Index TrapezoidalMap::new_trapezoid(Index bottom, Index top, const GridPoint& left,
                                                    const GridPoint& right) {
  auto index = static_cast<Index>(trapezoids_.size());
  if (free_trapezoids_.empty()) {
    trapezoids_.emplace_back();
  } else {
    index = free_trapezoids_.back();
    free_trapezoids_.pop_back();
  }
  const Index leaf = new_node(Kind::kTrapezoid, index);
  trapezoids_[index] = {.bottom = bottom, .top = top, .left = left, .right = right, .leaf = leaf};
  return index;
}

TrapezoidalMap::Index TrapezoidalMap::new_node(Kind kind, Index index, const std::array<Index, 2>& children) {
  nodes_.push_back({kind, index, children});
  return static_cast<Index>(nodes_.size() - 1);
}

void TrapezoidalMap::insert(Index s) {
  const GridSegment segment = segments_[s];
  find_crossed(segment);
  const Trapezoid first = trapezoids_[crossed_.front()], last = trapezoids_[crossed_.back()];
  Index left_part = kNone, right_part = kNone;
  if (first.left < segment.left) {
    left_part = new_trapezoid(first.bottom, first.top, first.left, segment.left);
    for (const std::size_t which : {kSameBottom, kSameTop})
      adopt_left_neighbour(left_part, which, first.left_neighbours[which], crossed_.front());
  }
  if (segment.right < last.right) {
    right_part = new_trapezoid(last.bottom, last.top, segment.right, last.right);
    for (const std::size_t which : {kSameBottom, kSameTop})
      adopt_right_neighbour(right_part, which, last.right_neighbours[which], crossed_.back());
  }
  divide_crossed(s, left_part, right_part);
  for (std::size_t i = 0; i < crossed_.size(); ++i) replace_leaf(i, s, left_part, right_part);
  for (const Index removed : crossed_) {
    trapezoids_[removed].leaf = kNone;
    free_trapezoids_.push_back(removed);
  }
}

void TrapezoidalMap::find_crossed(const GridSegment& segment) {
  crossed_.assign(1, locate_left_end(segment));
  for (;;) {
    const Trapezoid& here = trapezoids_[crossed_.back()];
    if (here.right >= segment.right) return;
    const std::int64_t height = height_above(segment, here.right);
    const Index next = here.right_neighbours[height > 0 ? kSameBottom : kSameTop];
    if (height == 0 || next == kNone) throw_crossing();
    crossed_.push_back(next);
  }
}

/// The trapezoid that a segment enters at its left end, which may also be an end of other segments.
TrapezoidalMap::Index TrapezoidalMap::locate_left_end(const GridSegment& segment) const {
  Index at = 0;
  while (nodes_[at].kind != Kind::kTrapezoid) {
    const Node& node = nodes_[at];
    const GridSegment& other = segments_[node.index];
    bool is_second = segment.left >= (node.kind == Kind::kRightEnd ? other.right : other.left);
    if (node.kind == Kind::kSegment) {
      std::int64_t height = height_above(other, segment.left);
      if (height == 0 && segment.left == other.left) height = height_above(other, segment.right);
      if (height == 0) throw_crossing();
      is_second = height > 0;
    }
    at = node.children[is_second ? 1 : 0];
  }
  return nodes_[at].index;
}

void TrapezoidalMap::divide_crossed(Index s, Index left_part, Index right_part) {
  const GridSegment segment = segments_[s];
  const Trapezoid first = trapezoids_[crossed_.front()];
  Index upper = new_trapezoid(s, first.top, segment.left, segment.right);
  Index lower = new_trapezoid(first.bottom, s, segment.left, segment.right);
  if (left_part == kNone) {
    adopt_left_neighbour(upper, kSameTop, first.left_neighbours[kSameTop], crossed_.front());
    adopt_left_neighbour(lower, kSameBottom, first.left_neighbours[kSameBottom], crossed_.front());
  } else {
    link(left_part, upper, kSameTop);
    link(left_part, lower, kSameBottom);
  }
  upper_.assign(1, upper);
  lower_.assign(1, lower);
  for (std::size_t i = 1; i < crossed_.size(); ++i) {
    const Trapezoid before = trapezoids_[crossed_[i - 1]], after = trapezoids_[crossed_[i]];
    // The segment cuts the wall between them, which remains only on the side of the point that causes it.
    const GridPoint wall = before.right;
    if (height_above(segment, wall) > 0) {
      const Index next = new_trapezoid(s, after.top, wall, segment.right);
      trapezoids_[upper].right = wall;
      link(upper, next, kSameBottom);
      adopt_right_neighbour(upper, kSameTop, before.right_neighbours[kSameTop], crossed_[i - 1]);
      adopt_left_neighbour(next, kSameTop, after.left_neighbours[kSameTop], crossed_[i]);
      upper = next;
    } else {
      const Index next = new_trapezoid(after.bottom, s, wall, segment.right);
      trapezoids_[lower].right = wall;
      link(lower, next, kSameTop);
      adopt_right_neighbour(lower, kSameBottom, before.right_neighbours[kSameBottom], crossed_[i - 1]);
      adopt_left_neighbour(next, kSameBottom, after.left_neighbours[kSameBottom], crossed_[i]);
      lower = next;
    }
    upper_.push_back(upper);
    lower_.push_back(lower);
  }
  const Trapezoid last = trapezoids_[crossed_.back()];
  if (right_part == kNone) {
    adopt_right_neighbour(upper, kSameTop, last.right_neighbours[kSameTop], crossed_.back());
    adopt_right_neighbour(lower, kSameBottom, last.right_neighbours[kSameBottom], crossed_.back());
  } else {
    link(upper, right_part, kSameTop);
    link(lower, right_part, kSameBottom);
  }
}

void TrapezoidalMap::replace_leaf(std::size_t i, Index s, Index left_part, Index right_part) {
  Node node{Kind::kSegment, s, {trapezoids_[lower_[i]].leaf, trapezoids_[upper_[i]].leaf}};
  if (i + 1 == crossed_.size() && right_part != kNone) {
    const Index inner = new_node(node.kind, node.index, node.children);
    node = {Kind::kRightEnd, s, {inner, trapezoids_[right_part].leaf}};
  }
  if (i == 0 && left_part != kNone) {
    const Index inner = new_node(node.kind, node.index, node.children);
    node = {Kind::kLeftEnd, s, {trapezoids_[left_part].leaf, inner}};
  }
  nodes_[trapezoids_[crossed_[i]].leaf] = node;
}

void TrapezoidalMap::adopt_left_neighbour(Index trapezoid, std::size_t which, Index neighbour,
                                          Index removed) {
  trapezoids_[trapezoid].left_neighbours[which] = neighbour;
  if (neighbour == kNone) return;
  for (Index& other : trapezoids_[neighbour].right_neighbours)
    if (other == removed) other = trapezoid;
}

void TrapezoidalMap::adopt_right_neighbour(Index trapezoid, std::size_t which, Index neighbour,
                                           Index removed) {
  trapezoids_[trapezoid].right_neighbours[which] = neighbour;
  if (neighbour == kNone) return;
  for (Index& other : trapezoids_[neighbour].left_neighbours)
    if (other == removed) other = trapezoid;
}

void TrapezoidalMap::link(Index left, Index right, std::size_t which) {
  trapezoids_[left].right_neighbours[which] = right;
  trapezoids_[right].left_neighbours[which] = left;
}

}  // namespace sidestep
