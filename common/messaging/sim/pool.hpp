// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace sidestep {

/// Values that come and go, by number; places are used again, the last one left first.
template <typename Value>
class Pool {
 public:
  std::uint32_t put(Value value) {
    if (free_.empty()) {
      values_.push_back(std::move(value));
      return static_cast<std::uint32_t>(values_.size() - 1);
    }
    const std::uint32_t place = free_.back();
    free_.pop_back();
    values_[place] = std::move(value);
    return place;
  }
  Value take(std::uint32_t place) {
    free_.push_back(place);
    return std::move(values_[place]);
  }
  Value& operator[](std::uint32_t place) { return values_[place]; }
  const Value& operator[](std::uint32_t place) const { return values_[place]; }

 private:
  std::vector<Value> values_;
  std::vector<std::uint32_t> free_;
};

}  // namespace sidestep
