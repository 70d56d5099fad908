// SPDX-License-Identifier: Apache-2.0
#include "common/collision/box_tree.hpp"

#include <bit>

#include "common/collision/box_tree_split.hpp"

namespace sidestep {

using collision::kLanes;
using collision::TreeNode;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr std::uint32_t kNone = 0xffffffffu;
constexpr std::uint32_t kMinChildren = 4;  // minimum number of children of a node other than the root

FloatBox lane_box(const TreeNode& node, std::uint32_t lane) {
  return {node.boxes.min_x_m[lane], node.boxes.min_y_m[lane], node.boxes.max_x_m[lane],
          node.boxes.max_y_m[lane]};
}

void set_lane_box(TreeNode& node, std::uint32_t lane, const FloatBox& box) {
  node.boxes.min_x_m[lane] = box.min_x_m;
  node.boxes.min_y_m[lane] = box.min_y_m;
  node.boxes.max_x_m[lane] = box.max_x_m;
  node.boxes.max_y_m[lane] = box.max_y_m;
}

bool equal(const FloatBox& a, const FloatBox& b) {
  return a.min_x_m == b.min_x_m && a.min_y_m == b.min_y_m && a.max_x_m == b.max_x_m && a.max_y_m == b.max_y_m;
}

}  // namespace

BoxTree::BoxTree(const ShapeStore& store) : origin_m_(store.origin_m()), locations_(store.end()) {
  std::vector<Item> slots;
  for (const Slot slot : store.slots()) slots.push_back({rounded_outwards(bounds(store.shape(slot))), slot});
  root_ = build(slots);
}

BoxTree::NodeId BoxTree::new_node(bool is_leaf) {
  auto id = static_cast<NodeId>(nodes_.size());
  if (free_nodes_.empty()) {
    nodes_.emplace_back();
  } else {
    id = free_nodes_.back();
    free_nodes_.pop_back();
  }
  TreeNode& node = nodes_[id];
  for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
    set_lane_box(node, lane, {kNan, kNan, kNan, kNan});
    node.children[lane] = 0;
  }
  node.parent = node.lane = kNone;
  node.count = 0;
  node.is_leaf = is_leaf;
  return id;
}

BoxTree::NodeId BoxTree::build(std::span<Item> slots) {
  const NodeId id = new_node(slots.size() <= kLanes);
  if (slots.size() <= kLanes) {
    for (const Item& slot : slots) append(id, slot);
    return id;
  }
  // Split the largest group until there are as many groups as lanes.
  std::vector<std::span<Item>> groups{slots};
  const auto smaller = [](const auto& a, const auto& b) { return a.size() < b.size(); };
  while (groups.size() < kLanes) {
    const auto largest = std::max_element(groups.begin(), groups.end(), smaller);
    if (largest->size() <= kLanes) break;
    const std::span<Item> group = *largest;
    const std::size_t cut = split_by_heuristic(group);
    *largest = group.first(cut);
    groups.push_back(group.subspan(cut));
  }
  for (const std::span<Item> group : groups) {
    const NodeId child = build(group);
    append(id, {box_of(child), child});
  }
  return id;
}

FloatBox BoxTree::rounded_outwards(const Box& box) const {
  const Vec2 low = box.min_m - origin_m_, high = box.max_m - origin_m_;
  return {rounded_down(low.x()), rounded_down(low.y()), rounded_up(high.x()), rounded_up(high.y())};
}

FloatBox BoxTree::box_of(NodeId id) const {
  FloatBox box = kEmptyBox;
  for (std::uint32_t lane = 0; lane < nodes_[id].count; ++lane) box = united(box, lane_box(nodes_[id], lane));
  return box;
}

void BoxTree::put(NodeId id, std::uint32_t lane, const Item& item) {
  TreeNode& node = nodes_[id];
  set_lane_box(node, lane, item.box);
  node.children[lane] = item.id;
  if (node.is_leaf) {
    locations_[item.id] = {id, lane};
  } else {
    nodes_[item.id].parent = id;
    nodes_[item.id].lane = lane;
  }
}

void BoxTree::append(NodeId id, const Item& item) { put(id, nodes_[id].count++, item); }

void BoxTree::remove_lane(NodeId id, std::uint32_t lane) {
  TreeNode& node = nodes_[id];
  const std::uint32_t last = --node.count;
  if (lane != last) put(id, lane, {lane_box(node, last), node.children[last]});
  set_lane_box(node, last, {kNan, kNan, kNan, kNan});
  node.children[last] = 0;
}

void BoxTree::refit(NodeId id) {
  while (nodes_[id].parent != kNone) {
    const FloatBox box = box_of(id);
    const std::uint32_t lane = nodes_[id].lane;
    id = nodes_[id].parent;
    if (equal(box, lane_box(nodes_[id], lane))) return;
    set_lane_box(nodes_[id], lane, box);
  }
}

void BoxTree::insert(const Item& slot) {
  NodeId id = root_;
  while (!nodes_[id].is_leaf) {
    const TreeNode& node = nodes_[id];
    std::uint32_t best = 0;
    float min_enlargement = std::numeric_limits<float>::infinity(), min_size = min_enlargement;
    for (std::uint32_t lane = 0; lane < node.count; ++lane) {
      const FloatBox box = lane_box(node, lane);
      const float size = half_perimeter(box), enlargement = half_perimeter(united(box, slot.box)) - size;
      if (enlargement > min_enlargement || (enlargement == min_enlargement && size >= min_size)) continue;
      min_enlargement = enlargement;
      min_size = size;
      best = lane;
    }
    id = node.children[best];
  }
  if (nodes_[id].count == kLanes) return split(id, slot);
  append(id, slot);
  refit(id);
}

void BoxTree::split(NodeId id, const Item& extra) {
  std::vector<Item> items{extra};
  for (std::uint32_t lane = 0; lane < kLanes; ++lane)
    items.push_back({lane_box(nodes_[id], lane), nodes_[id].children[lane]});
  const std::size_t cut = split_by_heuristic(std::span<Item>(items));
  while (nodes_[id].count > 0) remove_lane(id, nodes_[id].count - 1);
  const NodeId sibling = new_node(nodes_[id].is_leaf);
  for (std::size_t i = 0; i < items.size(); ++i) append(i < cut ? id : sibling, items[i]);
  NodeId parent = nodes_[id].parent;
  if (parent == kNone) {
    parent = root_ = new_node(false);
    append(parent, {box_of(id), id});
  } else {
    refit(id);
  }
  const Item second{box_of(sibling), sibling};
  if (nodes_[parent].count == kLanes) return split(parent, second);
  append(parent, second);
  refit(parent);
}

void BoxTree::erase(Slot slot) {
  NodeId id = locations_[slot].node;
  remove_lane(id, locations_[slot].lane);
  // Nodes with too few children are dissolved, and their slots inserted again.
  std::vector<Item> orphans;
  while (nodes_[id].parent != kNone && nodes_[id].count < kMinChildren) {
    const NodeId parent = nodes_[id].parent;
    const std::uint32_t lane = nodes_[id].lane;
    collect(id, orphans);
    remove_lane(parent, lane);
    id = parent;
  }
  refit(id);
  while (!nodes_[root_].is_leaf && nodes_[root_].count <= 1) {
    free_nodes_.push_back(root_);
    root_ = nodes_[root_].count == 1 ? nodes_[root_].children[0] : new_node(true);
    nodes_[root_].parent = nodes_[root_].lane = kNone;
  }
  for (const Item& item : orphans) insert(item);
}

void BoxTree::collect(NodeId id, std::vector<Item>& slots) {
  for (std::uint32_t lane = 0; lane < nodes_[id].count; ++lane) {
    if (nodes_[id].is_leaf)
      slots.push_back({lane_box(nodes_[id], lane), nodes_[id].children[lane]});
    else
      collect(nodes_[id].children[lane], slots);
  }
  free_nodes_.push_back(id);
}

void BoxTree::add(Slot slot, const Shape& shape) {
  if (slot >= locations_.size()) locations_.resize(slot + 1);
  insert({rounded_outwards(bounds(shape)), slot});
}

void BoxTree::replace(Slot slot, const Shape& shape) {
  const Item item{rounded_outwards(bounds(shape)), slot};
  const Location location = locations_[slot];
  const TreeNode& node = nodes_[location.node];
  const bool stays = node.parent == kNone || equal(united(lane_box(nodes_[node.parent], node.lane), item.box),
                                                   lane_box(nodes_[node.parent], node.lane));
  if (stays) {
    put(location.node, location.lane, item);
    refit(location.node);
  } else {
    erase(slot);
    insert(item);
  }
}

NearestSlot BoxTree::nearest(const Vec2& at, const ShapeStore& store) const {
  NearestSlot nearest;
  find_nearest(root_, at, store, nearest);
  return nearest;
}

void BoxTree::find_nearest(NodeId id, const Vec2& at, const ShapeStore& store, NearestSlot& nearest) const {
  const TreeNode& node = nodes_[id];
  const double x = at.x() - origin_m_.x(), y = at.y() - origin_m_.y();
  // Lower bounds of signed distances: inside a box, no shape is penetrated deeper than the box itself. Empty
  // lanes are skipped below.
  double distances_m[kLanes];
  for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
    const double left = node.boxes.min_x_m[lane] - x, right = x - node.boxes.max_x_m[lane];
    const double below = node.boxes.min_y_m[lane] - y, above = y - node.boxes.max_y_m[lane];
    const double dx = left > right ? left : right, dy = below > above ? below : above;
    const double outside_x = dx > 0 ? dx : 0, outside_y = dy > 0 ? dy : 0, penetration = dx > dy ? dx : dy;
    const double outside_distance = std::sqrt(outside_x * outside_x + outside_y * outside_y);
    distances_m[lane] = penetration > 0 ? outside_distance : penetration;
  }
  std::uint32_t remaining = (1u << node.count) - 1;
  while (remaining != 0) {
    std::uint32_t nearest_lane = 0;
    double min_distance_m = std::numeric_limits<double>::infinity();
    for (std::uint32_t bits = remaining; bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
      if (distances_m[lane] >= nearest.distance_m) {
        remaining &= ~(1u << lane);
      } else if (distances_m[lane] < min_distance_m) {
        min_distance_m = distances_m[lane];
        nearest_lane = lane;
      }
    }
    if (remaining == 0) return;
    remaining &= ~(1u << nearest_lane);
    if (node.is_leaf)
      store.compare(node.children[nearest_lane], at, nearest);
    else
      find_nearest(node.children[nearest_lane], at, store, nearest);
  }
}

void BoxTree::remove(Slot slot) { erase(slot); }

}  // namespace sidestep
