// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace sidestep {

/// K-D tree for nearest neighbours in a growing set of points in N dimensions (Bentley 1975). Leaves hold up
/// to kLeafCapacity points, compared in vector lanes; a full leaf is split at the median of its widest
/// extent. Points are numbered in the order of insertion; among equally near points the lowest index wins.
template <std::size_t N>
class KdTree {
 public:
  using Point = std::array<double, N>;

  KdTree() { clear(); }

  /// Removes all points but keeps the allocated memory.
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
      link = point[split.axis] < split.threshold ? &split.below : &split.above;
    }
    const auto index = static_cast<std::uint32_t>(size_++);
    std::uint32_t leaf = link->leaf();
    if (leaves_[leaf].count == kLeafCapacity) {
      const Split split = divide(leaf);
      leaf = point[split.axis] < split.threshold ? split.below.leaf() : split.above.leaf();
      *link = Link::to_split(splits_.size());
      splits_.push_back(split);
    }
    append(leaves_[leaf], point, index);
  }

  /// Index of the nearest point. Requires a non-empty set.
  std::uint32_t nearest(const Point& point) const {
    Nearest found;
    if (root_.is_leaf()) {
      scan(leaves_[root_.leaf()], point, found);
    } else {
      descend(root_, point, Point{}, 0, found);
    }
    return found.index;
  }

 private:
  static constexpr std::size_t kLeafCapacity = 16;

  /// The index of a split, or the bitwise complement of the index of a leaf.
  struct Link {
    std::int32_t value;
    static Link to_leaf(std::size_t i) { return {~static_cast<std::int32_t>(i)}; }
    static Link to_split(std::size_t i) { return {static_cast<std::int32_t>(i)}; }
    bool is_leaf() const { return value < 0; }
    std::uint32_t leaf() const { return static_cast<std::uint32_t>(~value); }
    std::uint32_t split() const { return static_cast<std::uint32_t>(value); }
  };
  struct Split {
    double threshold;
    std::uint32_t axis;
    Link below, above;
  };
  struct alignas(64) Leaf {
    double coordinate[N][kLeafCapacity];
    std::uint32_t index[kLeafCapacity];
    std::uint32_t count;
  };
  struct Nearest {
    double distance2 = std::numeric_limits<double>::infinity();
    std::uint32_t index = 0;
  };

  Link new_leaf() {
    leaves_.emplace_back();
    clear_leaf(leaves_.back());
    return Link::to_leaf(leaves_.size() - 1);
  }

  static void clear_leaf(Leaf& leaf) {
    leaf.count = 0;
    // Empty lanes are also compared, so their coordinates are infinite.
    for (auto& axis : leaf.coordinate)
      for (double& x : axis) x = std::numeric_limits<double>::infinity();
  }

  static void append(Leaf& leaf, const Point& point, std::uint32_t index) {
    for (std::size_t axis = 0; axis < N; ++axis) leaf.coordinate[axis][leaf.count] = point[axis];
    leaf.index[leaf.count++] = index;
  }

  /// Moves the upper half of a full leaf to a new leaf.
  Split divide(std::uint32_t full) {
    const Leaf all = leaves_[full];
    clear_leaf(leaves_[full]);
    const auto axis = widest_axis(all);
    std::array<std::uint8_t, kLeafCapacity> order{};
    for (std::size_t i = 0; i < kLeafCapacity; ++i) {
      std::size_t slot = i;
      while (slot > 0 && all.coordinate[axis][order[slot - 1]] > all.coordinate[axis][i]) {
        order[slot] = order[slot - 1];
        --slot;
      }
      order[slot] = static_cast<std::uint8_t>(i);
    }
    const Split split{all.coordinate[axis][order[kLeafCapacity / 2]], axis, Link::to_leaf(full), new_leaf()};
    for (std::size_t i = 0; i < kLeafCapacity; ++i) {
      Point point;
      for (std::size_t k = 0; k < N; ++k) point[k] = all.coordinate[k][order[i]];
      Leaf& half = leaves_[i < kLeafCapacity / 2 ? split.below.leaf() : split.above.leaf()];
      append(half, point, all.index[order[i]]);
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
    double distance2[kLeafCapacity] = {};
    for (std::size_t axis = 0; axis < N; ++axis) {
      for (std::size_t i = 0; i < kLeafCapacity; ++i) {
        const double d = leaf.coordinate[axis][i] - point[axis];
        distance2[i] += d * d;
      }
    }
    // First computes the minimum without branches: most leaves contain no nearer point.
    double minima[4] = {distance2[0], distance2[1], distance2[2], distance2[3]};
    for (std::size_t i = 4; i < kLeafCapacity; ++i)
      minima[i % 4] = distance2[i] < minima[i % 4] ? distance2[i] : minima[i % 4];
    const double low = minima[0] < minima[1] ? minima[0] : minima[1];
    const double high = minima[2] < minima[3] ? minima[2] : minima[3];
    const double nearest2 = low < high ? low : high;
    if (nearest2 > found.distance2) return;
    for (std::uint32_t i = 0; i < leaf.count; ++i) {
      if (distance2[i] != nearest2) continue;
      if (nearest2 < found.distance2 || leaf.index[i] < found.index) found = {nearest2, leaf.index[i]};
    }
  }

  /// `offset` is the distance of the point from the link's cell along each axis; `distance2` is its squared
  /// norm.
  void descend(Link link, const Point& point, Point offset, double distance2, Nearest& found) const {
    if (link.is_leaf()) return scan(leaves_[link.leaf()], point, found);
    const Split& split = splits_[link.split()];
    const double over = point[split.axis] - split.threshold;
    descend(over < 0 ? split.below : split.above, point, offset, distance2, found);
    const double far2 = distance2 - offset[split.axis] * offset[split.axis] + over * over;
    // Slightly reduced: rounding must not exclude an equally near point.
    if (far2 * (1 - 1e-12) > found.distance2) return;
    offset[split.axis] = over;
    descend(over < 0 ? split.above : split.below, point, offset, far2, found);
  }

  std::vector<Split> splits_;
  std::vector<Leaf> leaves_;
  Link root_{};
  std::size_t size_ = 0;
};

}  // namespace sidestep
