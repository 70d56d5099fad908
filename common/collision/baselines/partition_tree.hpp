// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "common/collision/shape_store.hpp"

namespace sidestep::baselines {

/// A binary space partitioning tree (Fuchs et al. 1980) whose dividing lines are perpendicular to a fixed set
/// of directions. With two directions, x and y, it is a K-D tree (Bentley 1975). Every leaf lists all
/// obstacles that may touch its region. A region is divided by the line that minimises the sum of the squared
/// numbers of obstacles on its two sides, if that reduces the cost enough. The tree is rebuilt when updates
/// have doubled the number of nodes.
template <std::size_t kDirections>
class PartitionTree {
 public:
  explicit PartitionTree(const ShapeStore& store);

  void add(Slot slot, const Shape& shape);
  void replace(Slot slot, const Shape& shape);
  void remove(Slot slot);

  /// Whether `test(slot)` is true for any obstacle whose box overlaps the sweep's box. An obstacle is tested
  /// once for each leaf that both the obstacle and the sweep may touch.
  template <typename Test>
  bool any_candidate(const Sweep& sweep, const Test& test) const {
    return any_in(0, sweep, sweep.bounds(), test);
  }

 private:
  struct Interval {
    double low_m, high_m;
  };
  /// The interval of a shape's projection on each direction, and its box.
  struct Extents {
    std::array<Interval, kDirections> along;
    Box box;
  };
  struct Node {
    std::uint32_t direction = kLeaf;
    std::uint32_t low = 0, high = 0;  // children on either side of the line; both include its points
    double offset_m = 0;              // offset of the dividing line
    std::vector<Slot> slots;          // obstacles of a leaf
  };
  struct Line {
    std::uint32_t direction;
    double offset_m;
  };
  static constexpr std::uint32_t kLeaf = 0xffffffffu;
  using NodeId = std::uint32_t;

  static double projected(const Vec2& position, std::uint32_t direction);
  static Extents extents_of(const Shape& shape);

  template <typename Test>
  bool any_in(NodeId id, const Sweep& sweep, const Box& box, const Test& test) const {
    const Node& node = nodes_[id];
    if (node.direction == kLeaf) {
      for (const Slot slot : node.slots)
        if (overlap(extents_[slot].box, box) && test(slot)) return true;
      return false;
    }
    const double from_m = projected(sweep.from_m, node.direction) - node.offset_m;
    const double to_m = projected(sweep.to_m, node.direction) - node.offset_m;
    if (std::min(from_m, to_m) <= sweep.radius_m && any_in(node.low, sweep, box, test)) return true;
    return std::max(from_m, to_m) >= -sweep.radius_m && any_in(node.high, sweep, box, test);
  }
  /// Calls `call(leaf)` for each leaf whose region the extents touch.
  template <typename Call>
  void for_each_leaf(NodeId id, const Extents& extents, const Call& call);

  /// The best line to divide a leaf's obstacles; its direction is kLeaf if none is good enough.
  Line best_line(const std::vector<Slot>& slots) const;
  /// Divides a leaf, and recursively the new leaves, where that reduces the cost.
  void divide(NodeId id);
  void rebuild();

  std::vector<Node> nodes_;
  std::vector<Extents> extents_;  // indexed by slot
  std::vector<bool> is_used_;     // indexed by slot
  std::size_t nodes_when_built_ = 1;
};

using KdTree = PartitionTree<2>;
using BspTree = PartitionTree<8>;

}  // namespace sidestep::baselines
