// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>

#include "common/collision/shape_store.hpp"

namespace sidestep {

/// Extent masks (Bruce 2006, chapter 3) with four look-ups per query. For each bucket of an axis, one bit
/// mask marks the obstacles that begin in or before it, and another those that end in or after it. The
/// intersection of the masks for the four bounds of a query's box contains all obstacles whose boxes it
/// overlaps. Unlike the sorted end points of the original, buckets have equal width: finding one takes a
/// multiplication, and moving an obstacle changes only its own bits. Obstacles outside the range of the
/// initial obstacles fall into the outermost buckets.
class ExtentMasks {
 public:
  explicit ExtentMasks(const ShapeStore& store);

  void add(Slot slot, const Shape& shape);
  void replace(Slot slot, const Shape& shape);
  void remove(Slot slot);

  /// Calls `call(slot)` for each slot whose box may overlap `box`.
  template <typename Call>
  void each_overlapping(const Box& box, const Call& call) const {
    const std::uint64_t* row[4];
    find_rows(box, row);
    for (std::size_t word = 0; word < words_; ++word) {
      for (std::uint64_t bits = row[0][word] & row[1][word] & row[2][word] & row[3][word]; bits != 0;
           bits &= bits - 1)
        call(static_cast<Slot>(64 * word) + static_cast<Slot>(std::countr_zero(bits)));
    }
  }

  collision::MasksView view() const { return {rows_.data(), words_, per_m_, shift_}; }

 private:
  /// The bucket of a coordinate relative to the origin.
  std::size_t bucket(std::size_t axis, double at_m) const;
  void find_rows(const Box& box, const std::uint64_t* (&row)[4]) const;
  /// Indexed by table. In the first two tables: the number of leading rows in which the slot's bit is set. In
  /// the last two: the number of leading rows in which it is clear. An unused slot has 0 and kBuckets.
  using Extents = std::array<std::uint16_t, 4>;
  static constexpr Extents kNone{0, 0, collision::kBuckets, collision::kBuckets};

  /// Flips the slot's bits in the rows between its old and its new extents.
  void set_extents(Slot slot, const Extents& extents);
  void widen(std::size_t words);

  std::size_t words_ = 1;
  Vec2 origin_m_;
  float per_m_[4] = {}, shift_[4] = {};
  std::vector<std::uint64_t> rows_;
  std::vector<Extents> extents_;  // indexed by slot
};

}  // namespace sidestep
