// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace sidestep {

/// Sorted numbers of one kind.
class Numbers {
 public:
  void add(double number) {
    numbers_.insert(std::upper_bound(numbers_.begin(), numbers_.end(), number), number);
  }
  void add(const Numbers& more) {
    const auto middle = static_cast<std::ptrdiff_t>(numbers_.size());
    numbers_.insert(numbers_.end(), more.numbers_.begin(), more.numbers_.end());
    std::inplace_merge(numbers_.begin(), numbers_.begin() + middle, numbers_.end());
  }
  std::size_t size() const { return numbers_.size(); }
  /// The least that so large a part of them do not exceed; 0 when there are none.
  double at(double part) const {
    if (numbers_.empty()) return 0;
    const auto i = static_cast<std::size_t>(part * static_cast<double>(numbers_.size()));
    return numbers_[std::min(i, numbers_.size() - 1)];
  }
  double median() const { return at(0.5); }
  double mean() const {
    if (numbers_.empty()) return 0;
    return std::accumulate(numbers_.begin(), numbers_.end(), 0.0) / static_cast<double>(numbers_.size());
  }

 private:
  std::vector<double> numbers_;
};

}  // namespace sidestep
