// SPDX-License-Identifier: Apache-2.0
#include "common/collision/baselines/partition_tree.hpp"

#include <algorithm>
#include <bit>
#include <numbers>
#include <utility>

namespace sidestep::baselines {
namespace {

constexpr std::size_t kMaxInLeaf = 4;  // leaves with this many obstacles or fewer are not divided
constexpr double kMaxCost = 0.7;       // cost of both sides relative to the undivided leaf; 0.5 is optimal
constexpr double kRelativeRounding = 1e-14;  // rounding of projections, relative to coordinates

template <std::size_t kCount>
std::array<Vec2, kCount> evenly_spaced_directions() {
  std::array<Vec2, kCount> directions;
  for (std::size_t i = 0; i < kCount; ++i)
    directions[i] = rotated({1, 0}, static_cast<double>(i) * std::numbers::pi / static_cast<double>(kCount));
  return directions;
}

}  // namespace

template <std::size_t kDirections>
PartitionTree<kDirections>::PartitionTree(const ShapeStore& store) {
  extents_.resize(store.end());
  is_used_.resize(store.end(), false);
  for (const Slot slot : store.slots()) {
    extents_[slot] = extents_of(store.shape(slot));
    is_used_[slot] = true;
  }
  rebuild();
}

template <std::size_t kDirections>
double PartitionTree<kDirections>::projected(const Vec2& position, std::uint32_t direction) {
  if constexpr (kDirections == 2) {
    return position[direction];
  } else {
    static const std::array<Vec2, kDirections> kUnit = evenly_spaced_directions<kDirections>();
    return kUnit[direction].dot(position);
  }
}

template <std::size_t kDirections>
typename PartitionTree<kDirections>::Extents PartitionTree<kDirections>::extents_of(const Shape& shape) {
  Extents extents;
  extents.box = bounds(shape);
  const double rounding_m = kRelativeRounding * std::max(extents.box.min_m.cwiseAbs().maxCoeff(),
                                                         extents.box.max_m.cwiseAbs().maxCoeff());
  for (std::uint32_t i = 0; i < kDirections; ++i) {
    Interval along{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    const auto include = [&](const Vec2& point, double radius_m) {
      const double at_m = projected(point, i);
      along.low_m = std::min(along.low_m, at_m - radius_m - rounding_m);
      along.high_m = std::max(along.high_m, at_m + radius_m + rounding_m);
    };
    if (const auto* circle = std::get_if<Circle>(&shape)) {
      include(circle->centre_m, circle->radius_m);
    } else if (const auto* box = std::get_if<Box>(&shape)) {
      for (const Vec2& corner : corners_of(*box)) include(corner, 0);
    } else if (const auto* polygon = std::get_if<ConvexPolygon>(&shape)) {
      for (const Vec2& corner : polygon->corners_m) include(corner, 0);
    } else {
      include(std::get<Segment>(shape).from_m, 0);
      include(std::get<Segment>(shape).to_m, 0);
    }
    extents.along[i] = along;
  }
  return extents;
}

template <std::size_t kDirections>
template <typename Call>
void PartitionTree<kDirections>::for_each_leaf(NodeId id, const Extents& extents, const Call& call) {
  // Copied, because the call may add nodes.
  const std::uint32_t direction = nodes_[id].direction, low = nodes_[id].low, high = nodes_[id].high;
  const double offset_m = nodes_[id].offset_m;
  if (direction == kLeaf) return call(id);
  if (extents.along[direction].low_m <= offset_m) for_each_leaf(low, extents, call);
  if (extents.along[direction].high_m >= offset_m) for_each_leaf(high, extents, call);
}

template <std::size_t kDirections>
void PartitionTree<kDirections>::add(Slot slot, const Shape& shape) {
  if (slot >= extents_.size()) {
    extents_.resize(slot + 1);
    is_used_.resize(slot + 1, false);
  }
  extents_[slot] = extents_of(shape);
  is_used_[slot] = true;
  const Extents extents = extents_[slot];
  for_each_leaf(0, extents, [&](NodeId leaf) {
    nodes_[leaf].slots.push_back(slot);
    // Tries only at powers of two; otherwise it would retry at each insertion if the leaf cannot be divided.
    const std::size_t size = nodes_[leaf].slots.size();
    if (size > 2 * kMaxInLeaf && std::has_single_bit(size)) divide(leaf);
  });
  if (nodes_.size() > 2 * nodes_when_built_ + 64) rebuild();
}

template <std::size_t kDirections>
void PartitionTree<kDirections>::replace(Slot slot, const Shape& shape) {
  remove(slot);
  add(slot, shape);
}

template <std::size_t kDirections>
void PartitionTree<kDirections>::remove(Slot slot) {
  for_each_leaf(0, extents_[slot], [&](NodeId leaf) { std::erase(nodes_[leaf].slots, slot); });
  is_used_[slot] = false;
}

template <std::size_t kDirections>
typename PartitionTree<kDirections>::Line PartitionTree<kDirections>::best_line(
    const std::vector<Slot>& slots) const {
  const auto count = static_cast<double>(slots.size());
  Line best{kLeaf, 0};
  double best_cost = kMaxCost * count * count;
  std::vector<double> lows, highs, ends;
  for (std::uint32_t direction = 0; direction < kDirections; ++direction) {
    lows.clear();
    highs.clear();
    for (const Slot slot : slots) {
      lows.push_back(extents_[slot].along[direction].low_m);
      highs.push_back(extents_[slot].along[direction].high_m);
    }
    std::sort(lows.begin(), lows.end());
    std::sort(highs.begin(), highs.end());
    ends.resize(2 * slots.size());
    std::merge(lows.begin(), lows.end(), highs.begin(), highs.end(), ends.begin());
    std::size_t begun = 0, ended = 0;
    for (std::size_t i = 1; i < ends.size(); ++i) {
      const double offset_m = 0.5 * ends[i - 1] + 0.5 * ends[i];
      while (begun < lows.size() && lows[begun] <= offset_m) ++begun;
      while (ended < highs.size() && highs[ended] < offset_m) ++ended;
      const auto low = static_cast<double>(begun), high = static_cast<double>(highs.size() - ended);
      if (low * low + high * high >= best_cost) continue;
      best_cost = low * low + high * high;
      best = {direction, offset_m};
    }
  }
  return best;
}

template <std::size_t kDirections>
void PartitionTree<kDirections>::divide(NodeId id) {
  if (nodes_[id].slots.size() <= kMaxInLeaf) return;
  const Line line = best_line(nodes_[id].slots);
  if (line.direction == kLeaf) return;
  const std::vector<Slot> slots = std::exchange(nodes_[id].slots, {});
  const auto low = static_cast<NodeId>(nodes_.size()), high = low + 1;
  nodes_.resize(nodes_.size() + 2);
  nodes_[id] = {line.direction, low, high, line.offset_m, {}};
  for (const Slot slot : slots) {
    const Interval& along = extents_[slot].along[line.direction];
    if (along.low_m <= line.offset_m) nodes_[low].slots.push_back(slot);
    if (along.high_m >= line.offset_m) nodes_[high].slots.push_back(slot);
  }
  divide(low);
  divide(high);
}

template <std::size_t kDirections>
void PartitionTree<kDirections>::rebuild() {
  nodes_.assign(1, {});
  for (Slot slot = 0; slot < extents_.size(); ++slot)
    if (is_used_[slot]) nodes_[0].slots.push_back(slot);
  divide(0);
  nodes_when_built_ = nodes_.size();
}

template class PartitionTree<2>;
template class PartitionTree<8>;

}  // namespace sidestep::baselines
