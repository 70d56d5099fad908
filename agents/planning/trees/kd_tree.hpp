// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace sidestep {

/// The nearest of a growing set of points in N dimensions (Bentley 1975): leaves hold up to kLeaf points,
/// which are compared side by side, and split at the median of their widest extent when full. Points keep
/// the order in which they were added as their number; of equally near ones the first is the nearest.
template <std::size_t N>
class KdTree {
 public:
  using Point = std::array<double, N>;

  KdTree() { clear(); }

  /// Keeps the memory.
  void clear() {
    splits_.clear();
    leaves_.clear();
    root_ = new_leaf();
    size_ = 0;
  }
  std::size_t size() const { return size_; }

  void add(const Point& point) {
    Link* link = &root_;
    while (!link->is_leaf()) {
      Split& split = splits_[link->split()];
      link = point[split.axis] < split.at ? &split.below : &split.above;
    }
    const auto number = static_cast<std::uint32_t>(size_++);
    std::uint32_t leaf = link->leaf();
    if (leaves_[leaf].count == kLeaf) {
      const Split split = divide(leaf);
      leaf = point[split.axis] < split.at ? split.below.leaf() : split.above.leaf();
      *link = Link::to_split(splits_.size());
      splits_.push_back(split);
    }
    put(leaves_[leaf], point, number);
  }

  /// The number of the nearest point; the set is not empty.
  std::uint32_t nearest(const Point& point) const {
    Nearest found;
    if (root_.is_leaf()) {
      scan(leaves_[root_.leaf()], point, found);
    } else {
      descend(root_, point, Point{}, 0, found);
    }
    return found.number;
  }

 private:
  static constexpr std::size_t kLeaf = 16;

  /// To a split, or to a leaf where the sign is negative.
  struct Link {
    std::int32_t value;
    static Link to_leaf(std::size_t i) { return {~static_cast<std::int32_t>(i)}; }
    static Link to_split(std::size_t i) { return {static_cast<std::int32_t>(i)}; }
    bool is_leaf() const { return value < 0; }
    std::uint32_t leaf() const { return static_cast<std::uint32_t>(~value); }
    std::uint32_t split() const { return static_cast<std::uint32_t>(value); }
  };
  struct Split {
    double at;
    std::uint32_t axis;
    Link below, above;
  };
  struct alignas(64) Leaf {
    double coordinate[N][kLeaf];
    std::uint32_t number[kLeaf];
    std::uint32_t count;
  };
  struct Nearest {
    double distance2 = std::numeric_limits<double>::infinity();
    std::uint32_t number = 0;
  };

  Link new_leaf() {
    leaves_.emplace_back();
    empty(leaves_.back());
    return Link::to_leaf(leaves_.size() - 1);
  }

  static void empty(Leaf& leaf) {
    leaf.count = 0;
    // Lanes without a point are compared as well.
    for (auto& axis : leaf.coordinate)
      for (double& x : axis) x = std::numeric_limits<double>::infinity();
  }

  static void put(Leaf& leaf, const Point& point, std::uint32_t number) {
    for (std::size_t axis = 0; axis < N; ++axis) leaf.coordinate[axis][leaf.count] = point[axis];
    leaf.number[leaf.count++] = number;
  }

  /// Divides a full leaf into itself and a new one.
  Split divide(std::uint32_t full) {
    const Leaf all = leaves_[full];
    empty(leaves_[full]);
    const auto axis = widest_axis(all);
    std::array<std::uint8_t, kLeaf> order;
    for (std::size_t i = 0; i < kLeaf; ++i) {
      std::size_t at = i;
      while (at > 0 && all.coordinate[axis][order[at - 1]] > all.coordinate[axis][i]) {
        order[at] = order[at - 1];
        --at;
      }
      order[at] = static_cast<std::uint8_t>(i);
    }
    const Split split{all.coordinate[axis][order[kLeaf / 2]], axis, Link::to_leaf(full), new_leaf()};
    for (std::size_t i = 0; i < kLeaf; ++i) {
      Point point;
      for (std::size_t k = 0; k < N; ++k) point[k] = all.coordinate[k][order[i]];
      Leaf& half = leaves_[i < kLeaf / 2 ? split.below.leaf() : split.above.leaf()];
      put(half, point, all.number[order[i]]);
    }
    return split;
  }

  static std::uint32_t widest_axis(const Leaf& leaf) {
    std::uint32_t widest = 0;
    double extent = -1;
    for (std::uint32_t axis = 0; axis < N; ++axis) {
      double low = leaf.coordinate[axis][0], high = low;
      for (const double x : leaf.coordinate[axis]) {
        low = x < low ? x : low;
        high = x > high ? x : high;
      }
      if (high - low > extent) {
        extent = high - low;
        widest = axis;
      }
    }
    return widest;
  }

  static void scan(const Leaf& leaf, const Point& point, Nearest& found) {
    double distance2[kLeaf] = {};
    for (std::size_t axis = 0; axis < N; ++axis) {
      for (std::size_t i = 0; i < kLeaf; ++i) {
        const double d = leaf.coordinate[axis][i] - point[axis];
        distance2[i] += d * d;
      }
    }
    // The least first, without branches: most leaves hold nothing nearer.
    double least[4] = {distance2[0], distance2[1], distance2[2], distance2[3]};
    for (std::size_t i = 4; i < kLeaf; ++i)
      least[i % 4] = distance2[i] < least[i % 4] ? distance2[i] : least[i % 4];
    const double low = least[0] < least[1] ? least[0] : least[1];
    const double high = least[2] < least[3] ? least[2] : least[3];
    const double nearest2 = low < high ? low : high;
    if (nearest2 > found.distance2) return;
    for (std::uint32_t i = 0; i < leaf.count; ++i) {
      if (distance2[i] != nearest2) continue;
      if (nearest2 < found.distance2 || leaf.number[i] < found.number) found = {nearest2, leaf.number[i]};
    }
  }

  /// `beyond`: how far the point lies outside of the link's cell on each axis; `distance2` their square.
  void descend(Link link, const Point& point, Point beyond, double distance2, Nearest& found) const {
    if (link.is_leaf()) return scan(leaves_[link.leaf()], point, found);
    const Split& split = splits_[link.split()];
    const double over = point[split.axis] - split.at;
    descend(over < 0 ? split.below : split.above, point, beyond, distance2, found);
    const double far2 = distance2 - beyond[split.axis] * beyond[split.axis] + over * over;
    // A little less, so that rounding hides no point that is as near.
    if (far2 * (1 - 1e-12) > found.distance2) return;
    beyond[split.axis] = over;
    descend(over < 0 ? split.above : split.below, point, beyond, far2, found);
  }

  std::vector<Split> splits_;
  std::vector<Leaf> leaves_;
  Link root_{};
  std::size_t size_ = 0;
};

}  // namespace sidestep
