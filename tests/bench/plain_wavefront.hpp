// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/grids/navigation/bucket_queue.hpp"
#include "agents/planning/grids/navigation/cost_grid.hpp"
#include "agents/planning/grids/navigation/kernels.hpp"

namespace sidestep {

/// The baseline for E*: fast marching with the same kernel, arrays and queue, but without support for
/// replanning.
class PlainWavefront {
 public:
  struct Start {
    GridCell cell;
    float value;
  };

  explicit PlainWavefront(const CostGrid& grid) : columns_(grid.layout().columns), stride_(columns_ + 2) {
    costs_.assign(std::size_t{stride_} * (grid.layout().rows + 4), kBlocked);
    values_.assign(costs_.size(), kBlocked);
    for (GridCell cell = 0; cell < grid.layout().size(); ++cell) costs_[padded(cell)] = grid.cost(cell);
  }

  void propagate(const std::vector<Start>& starts) {
    std::fill(values_.begin(), values_.end(), kBlocked);
    queue_.clear();
    for (const Start& start : starts) {
      values_[padded(start.cell)] = start.value;
      queue_.push(start.value, padded(start.cell));
    }
    while (queue_.advance([this](std::uint32_t at) { return values_[at]; })) {
      auto& bucket = queue_.first_lane();
      for (std::size_t i = 0; i < bucket.size(); ++i) expand(bucket[i]);
      bucket.clear();
    }
  }

  float value(GridCell cell) const { return values_[padded(cell)]; }

 private:
  std::uint32_t padded(GridCell cell) const { return cell + 2 * stride_ + 1 + 2 * (cell / columns_); }

  void expand(std::uint32_t at) {
    const float value = values_[at];
    if (!queue_.is_in_current(value)) return;
    if (values_[at - 1] > value) lower(at - 1);
    if (values_[at + 1] > value) lower(at + 1);
    if (values_[at - stride_] > value) lower(at - stride_);
    if (values_[at + stride_] > value) lower(at + stride_);
  }

  void lower(std::uint32_t at) {
    const float x = std::min(values_[at - 1], values_[at + 1]);
    const float y = std::min(values_[at - stride_], values_[at + stride_]);
    const float value = LsmKernel::value(std::min(x, y), std::max(x, y), costs_[at]);
    if (!(value < values_[at])) return;
    values_[at] = value;
    queue_.push(value, at);
  }

  std::uint32_t columns_, stride_;
  std::vector<float> costs_, values_;
  BucketQueue queue_;
};

}  // namespace sidestep
