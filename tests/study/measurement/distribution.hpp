// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace sidestep {

/// Values of one quantity, kept sorted.
class Distribution {
 public:
  void add(double value) { values_.insert(std::upper_bound(values_.begin(), values_.end(), value), value); }
  void add(const Distribution& other) {
    const auto middle = static_cast<std::ptrdiff_t>(values_.size());
    values_.insert(values_.end(), other.values_.begin(), other.values_.end());
    std::inplace_merge(values_.begin(), values_.begin() + middle, values_.end());
  }
  /// A copy in which all values are increased by the same amount.
  Distribution shifted(double by) const {
    Distribution result = *this;
    for (double& value : result.values_) value += by;
    return result;
  }
  std::size_t size() const { return values_.size(); }
  /// The value at `fraction` (0 to 1) of the sorted values; 0 if there are none.
  double quantile(double fraction) const {
    if (values_.empty()) return 0;
    const auto i = static_cast<std::size_t>(fraction * static_cast<double>(values_.size()));
    return values_[std::min(i, values_.size() - 1)];
  }
  double median() const { return quantile(0.5); }
  double mean() const {
    if (values_.empty()) return 0;
    return std::accumulate(values_.begin(), values_.end(), 0.0) / static_cast<double>(values_.size());
  }

 private:
  std::vector<double> values_;
};

/// The minimum number of values for which a 99th percentile is reported.
inline constexpr std::size_t kMinForP99 = 1000;

}  // namespace sidestep
