// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include "common/collision/box_tree.hpp"

namespace sidestep {

inline constexpr FloatBox kEmptyBox{
    std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity(),
    -std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()};

inline FloatBox united(const FloatBox& a, const FloatBox& b) {
  return {std::min(a.min_x_m, b.min_x_m), std::min(a.min_y_m, b.min_y_m), std::max(a.max_x_m, b.max_x_m),
          std::max(a.max_y_m, b.max_y_m)};
}

inline float half_perimeter(const FloatBox& box) {
  return box.max_x_m - box.min_x_m + box.max_y_m - box.min_y_m;
}

/// Reorders the items for the best split and returns the number of items on its first side. Candidates are
/// all cuts of the items sorted by x and by y that leave at least a quarter on each side. The best one has
/// the smallest sum, over both sides, of half perimeter times number of leaves required.
template <typename Item>
std::size_t split_by_heuristic(std::span<Item> items) {
  const auto leaves = [](std::size_t count) {
    const std::size_t full = (count + collision::kLanes - 1) / collision::kLanes;
    return static_cast<float>(full);
  };
  const auto by_x = [](const Item& a, const Item& b) {
    return a.box.min_x_m + a.box.max_x_m < b.box.min_x_m + b.box.max_x_m;
  };
  const auto by_y = [](const Item& a, const Item& b) {
    return a.box.min_y_m + a.box.max_y_m < b.box.min_y_m + b.box.max_y_m;
  };
  const std::size_t min_count = std::max<std::size_t>(1, items.size() / 4);
  std::vector<float> after(items.size() + 1);
  std::size_t best_cut = items.size() / 2;
  float best_cost = std::numeric_limits<float>::infinity();
  bool best_is_x = false;
  for (const bool is_x : {true, false}) {
    if (is_x)
      std::sort(items.begin(), items.end(), by_x);
    else
      std::sort(items.begin(), items.end(), by_y);
    FloatBox box = kEmptyBox;
    for (std::size_t i = items.size(); i > min_count; --i) {
      box = united(box, items[i - 1].box);
      after[i - 1] = half_perimeter(box) * leaves(items.size() - (i - 1));
    }
    box = kEmptyBox;
    for (std::size_t i = 0; i < items.size() - min_count; ++i) {
      box = united(box, items[i].box);
      const float cost = half_perimeter(box) * leaves(i + 1) + after[i + 1];
      if (i + 1 < min_count || cost >= best_cost) continue;
      best_cost = cost;
      best_cut = i + 1;
      best_is_x = is_x;
    }
  }
  if (best_is_x) std::sort(items.begin(), items.end(), by_x);
  return best_cut;
}

}  // namespace sidestep
