// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>

#include "common/collision/shape_store.hpp"

namespace sidestep {

/// A box in single precision, in metres from an origin, rounded outwards.
struct FloatBox {
  float min_x_m, min_y_m, max_x_m, max_y_m;
};

/// A tree of axis-aligned boxes in a flat array. A node's boxes, up to sixteen, are compared together. It is
/// built top-down by the surface area heuristic (MacDonald and Booth 1990) on half perimeters, and updated
/// like an R-tree (Guttman 1984), with the same heuristic for splitting full nodes.
class BoxTree {
 public:
  explicit BoxTree(const ShapeStore& store);

  void add(Slot slot, const Shape& shape);
  void replace(Slot slot, const Shape& shape);
  void remove(Slot slot);

  /// Calls `call(slot)` for each slot whose box overlaps `box`.
  template <typename Call>
  void each_overlapping(const Box& box, const Call& call) const {
    each_overlapping(root_, rounded_outwards(box), call);
  }
  NearestSlot nearest(const Vec2& at_m, const ShapeStore& store) const;

  collision::TreeView view() const { return {nodes_.data(), root_}; }

 private:
  using NodeId = std::uint32_t;

  /// An entry of a node: a slot (in leaves) or a child node, with its box.
  struct Item {
    FloatBox box;
    std::uint32_t id;
  };
  struct Location {
    NodeId node;
    std::uint32_t lane;
  };

  template <typename Call>
  void each_overlapping(NodeId id, const FloatBox& box, const Call& call) const {
    const collision::TreeNode& node = nodes_[id];
    for (std::uint32_t lane = 0; lane < node.count; ++lane) {
      if (!(node.boxes.min_x_m[lane] <= box.max_x_m && box.min_x_m <= node.boxes.max_x_m[lane] &&
            node.boxes.min_y_m[lane] <= box.max_y_m && box.min_y_m <= node.boxes.max_y_m[lane]))
        continue;
      if (node.is_leaf)
        call(node.children[lane]);
      else
        each_overlapping(node.children[lane], box, call);
    }
  }
  void find_nearest(NodeId id, const Vec2& at_m, const ShapeStore& store, NearestSlot& nearest) const;

  NodeId new_node(bool is_leaf);
  NodeId build(std::span<Item> slots);
  FloatBox rounded_outwards(const Box& box) const;
  FloatBox box_of(NodeId node) const;

  /// Writes an item into a lane of a node and updates its back reference.
  void put(NodeId node, std::uint32_t lane, const Item& item);
  void remove_lane(NodeId node, std::uint32_t lane);
  void insert(const Item& slot);
  void append(NodeId node, const Item& item);
  void split(NodeId node, const Item& extra);
  /// Updates the node's box in its parent, and the boxes of all ancestors.
  void refit(NodeId node);
  void erase(Slot slot);
  void collect(NodeId node, std::vector<Item>& slots);

  Vec2 origin_m_;
  std::vector<collision::TreeNode> nodes_;
  std::vector<NodeId> free_nodes_;
  std::vector<Location> locations_;  // indexed by slot
  NodeId root_ = 0;
};

}  // namespace sidestep
