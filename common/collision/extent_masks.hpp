// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>

#include "common/collision/bodies.hpp"

namespace sidestep {

/// Extent masks (Bruce 2006, chapter 3) that take a query four look-ups: for each bucket of an axis a bit
/// mask of the obstacles that begin before its end, and one of those that do not end before it; the obstacles
/// whose box the query's overlaps are in the masks of the query's four bounds. Instead of the sorted end
/// points of the original, buckets are equally wide: finding one takes a product, and an obstacle that moves
/// changes only its own bits. Obstacles outside of the range of the first ones count for the outermost
/// buckets.
class ExtentMasks {
 public:
  explicit ExtentMasks(const Bodies& bodies);

  void add(Slot slot, const Shape& shape);
  void replace(Slot slot, const Shape& shape);
  void remove(Slot slot);

  /// Calls for each slot whose box may overlap the box.
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
  /// Of a number in metres from the origin.
  std::size_t bucket(std::size_t axis, double at_m) const;
  void find_rows(const Box& box, const std::uint64_t* (&row)[4]) const;
  /// How many of a table's first rows have the slot's bit set, or, of those of begins, do not: 0 and all for
  /// none.
  using Ends = std::array<std::uint16_t, 4>;
  static constexpr Ends kNone{0, 0, collision::kBuckets, collision::kBuckets};

  /// Changes the slot's bits where the ends differ.
  void set_ends(Slot slot, const Ends& ends);
  void widen(std::size_t words);

  std::size_t words_ = 1;
  Vec2 origin_m_;
  float per_m_[4], shift_[4];
  std::vector<std::uint64_t> rows_;
  std::vector<Ends> ends_;  // by slot
};

}  // namespace sidestep
