// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "common/collision/shape_store.hpp"

namespace sidestep::baselines {

/// Obstacles sorted by the lower ends of their boxes on one axis (Baraff 1992; Cohen et al. 1995). A query
/// compares the boxes that begin before its upper end, and after its lower end minus the length of the
/// longest box. The axis is the one on which the obstacles are spread more widely. A moved obstacle is
/// swapped with its neighbours until the order is restored, which takes few swaps if it moves little.
class SweepAndPrune {
 public:
  explicit SweepAndPrune(const ShapeStore& store);

  void add(Slot slot, const Shape& shape);
  void replace(Slot slot, const Shape& shape);
  void remove(Slot slot);

  /// Whether `test(slot)` is true for any obstacle whose box overlaps the sweep's box. Tests each at most
  /// once.
  template <typename Test>
  bool any_candidate(const Sweep& sweep, const Test& test) const {
    const Box box = sweep.bounds();
    const double low_m = box.min_m[axis_], high_m = box.max_m[axis_];
    const double rounding_m = 0x1p-50 * (std::abs(low_m) + max_length_m_);
    const auto first = std::lower_bound(lows_m_.begin(), lows_m_.end(), low_m - max_length_m_ - rounding_m);
    for (auto i = static_cast<std::size_t>(first - lows_m_.begin());
         i < lows_m_.size() && lows_m_[i] <= high_m; ++i)
      if (overlap(boxes_[i], box) && test(slots_[i])) return true;
    return false;
  }

 private:
  /// Writes the obstacle at an index of the sorted arrays.
  void put(std::size_t i, const Box& box, Slot slot);
  /// Swaps the obstacle at an index with its neighbours until the order is restored.
  void restore_order_at(std::size_t i);
  void exchange(std::size_t i, std::size_t j);

  Eigen::Index axis_ = 0;
  double max_length_m_ = 0;     // longest box so far, along the axis
  std::vector<double> lows_m_;  // ascending; boxes_ and slots_ have the same order
  std::vector<Box> boxes_;
  std::vector<Slot> slots_;
  std::vector<std::size_t> indices_;  // indexed by slot
};

}  // namespace sidestep::baselines
