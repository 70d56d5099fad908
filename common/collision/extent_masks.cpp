// SPDX-License-Identifier: Apache-2.0
#include "common/collision/extent_masks.hpp"

#include <algorithm>

namespace sidestep {

using collision::kBuckets;

namespace {

constexpr std::size_t kTables = 4;
constexpr std::size_t kBits = 64;

}  // namespace

ExtentMasks::ExtentMasks(const ShapeStore& store)
    : words_(std::max<std::size_t>(1, (store.end() + kBits - 1) / kBits)), origin_m_(store.origin_m()) {
  Box box{origin_m_, origin_m_};
  for (const Slot slot : store.slots()) box = united(box, bounds(store.shape(slot)));
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto row = static_cast<Eigen::Index>(axis);
    const double range_m = box.max_m[row] - box.min_m[row], per_m = range_m > 1e-15 ? kBuckets / range_m : 0;
    per_m_[axis] = static_cast<float>(per_m);
    per_m_[axis + 2] = -per_m_[axis];
    shift_[axis] = shift_[axis + 2] = static_cast<float>(per_m * (origin_m_[row] - box.min_m[row]));
  }
  rows_.assign(kTables * kBuckets * words_, 0);
  for (const Slot slot : store.slots()) add(slot, store.shape(slot));
}

void ExtentMasks::add(Slot slot, const Shape& shape) {
  if (slot >= words_ * kBits) widen(2 * words_);
  if (slot >= extents_.size()) extents_.resize(slot + 1, kNone);
  replace(slot, shape);
}

void ExtentMasks::replace(Slot slot, const Shape& shape) {
  const Box box = bounds(shape);
  Extents extents{};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto at = static_cast<Eigen::Index>(axis);
    extents[axis] = static_cast<std::uint16_t>(bucket(axis, box.max_m[at] - origin_m_[at]) + 1);
    extents[axis + 2] = static_cast<std::uint16_t>(bucket(axis, box.min_m[at] - origin_m_[at]));
  }
  set_extents(slot, extents);
}

void ExtentMasks::remove(Slot slot) { set_extents(slot, kNone); }

void ExtentMasks::set_extents(Slot slot, const Extents& extents) {
  const std::uint64_t bit = std::uint64_t{1} << (slot % kBits);
  for (std::size_t table = 0; table < kTables; ++table) {
    const std::size_t before = extents_[slot][table], after = extents[table];
    for (std::size_t row = std::min(before, after); row < std::max(before, after); ++row)
      rows_[(table * kBuckets + row) * words_ + slot / kBits] ^= bit;
  }
  extents_[slot] = extents;
}

std::size_t ExtentMasks::bucket(std::size_t axis, double at_m) const {
  const double scaled = at_m * per_m_[axis] + shift_[axis];
  return scaled > 0 ? static_cast<std::size_t>(std::min(scaled, kBuckets - 1.0)) : 0;
}

void ExtentMasks::find_rows(const Box& box, const std::uint64_t* (&row)[4]) const {
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto at = static_cast<Eigen::Index>(axis);
    const std::size_t low = bucket(axis, box.min_m[at] - origin_m_[at]);
    const std::size_t high = bucket(axis, box.max_m[at] - origin_m_[at]);
    row[axis] = &rows_[(axis * kBuckets + low) * words_];
    row[axis + 2] = &rows_[((axis + 2) * kBuckets + high) * words_];
  }
}

void ExtentMasks::widen(std::size_t words) {
  std::vector<std::uint64_t> rows(kTables * kBuckets * words, 0);
  for (std::size_t row = 0; row < kTables * kBuckets; ++row) {
    std::copy_n(rows_.begin() + static_cast<std::ptrdiff_t>(row * words_), words_,
                rows.begin() + static_cast<std::ptrdiff_t>(row * words));
  }
  rows_ = std::move(rows);
  words_ = words;
}

}  // namespace sidestep
