// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace sidestep {

/// Values addressed by index. Reuses the most recently freed index first, and allocates only if no index is
/// free.
template <typename Value>
class Pool {
 public:
  std::uint32_t add(Value value) {
    if (free_.empty()) {
      values_.push_back(std::move(value));
      return static_cast<std::uint32_t>(values_.size() - 1);
    }
    const std::uint32_t index = free_.back();
    free_.pop_back();
    values_[index] = std::move(value);
    return index;
  }
  Value remove(std::uint32_t index) {
    free_.push_back(index);
    return std::move(values_[index]);
  }
  Value& operator[](std::uint32_t index) { return values_[index]; }

 private:
  std::vector<Value> values_;
  std::vector<std::uint32_t> free_;
};

}  // namespace sidestep
