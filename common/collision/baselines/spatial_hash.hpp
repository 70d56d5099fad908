// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/collision/shape_store.hpp"

namespace sidestep::baselines {

/// Square cells in a hash table, each with the obstacles whose boxes it overlaps (Teschner et al. 2003,
/// section 4). Cells are as wide as the mean obstacle, and at least as wide as the obstacles' spacing.
/// Obstacles that overlap more than 64 cells are compared with every query.
class SpatialHash {
 public:
  explicit SpatialHash(const ShapeStore& store);

  void add(Slot slot, const Shape& shape);
  void replace(Slot slot, const Shape& shape);
  void remove(Slot slot);

  /// Whether `test(slot)` is true for any obstacle whose box overlaps the sweep's box. Tests each at most
  /// once.
  template <typename Test>
  bool any_candidate(const Sweep& sweep, const Test& test) const {
    const Box box = sweep.bounds();
    const auto passes = [&](Slot slot) { return overlap(boxes_[slot], box) && test(slot); };
    const CellRange range = cells_of(box);
    if (range.count() > boxes_.size()) {
      for (Slot slot = 0; slot < boxes_.size(); ++slot)
        if (passes(slot)) return true;
      return false;
    }
    for (const Slot slot : large_)
      if (passes(slot)) return true;
    for (std::int32_t y = range.min_y; y <= range.max_y; ++y) {
      for (std::int32_t x = range.min_x; x <= range.max_x; ++x) {
        for (std::uint32_t i = heads_[bucket(x, y)]; i != kNone; i = entries_[i].next) {
          const Entry& entry = entries_[i];
          if (entry.x != x || entry.y != y) continue;
          // An obstacle in several of the query's cells is tested only in the first of them.
          const CellRange& own = ranges_[entry.slot];
          if (x != std::max(range.min_x, own.min_x) || y != std::max(range.min_y, own.min_y)) continue;
          if (passes(entry.slot)) return true;
        }
      }
    }
    return false;
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  struct CellRange {
    std::int32_t min_x = 0, min_y = 0, max_x = -1, max_y = -1;
    std::uint64_t count() const {
      return static_cast<std::uint64_t>(std::int64_t{max_x} - min_x + 1) *
             static_cast<std::uint64_t>(std::int64_t{max_y} - min_y + 1);
    }
  };
  /// An obstacle in a cell; an element of its bucket's linked list.
  struct Entry {
    std::int32_t x, y;
    Slot slot;
    std::uint32_t next;
  };

  std::int32_t cell(double at_m) const;
  CellRange cells_of(const Box& box) const;
  std::uint32_t bucket(std::int32_t x, std::int32_t y) const {
    return ((static_cast<std::uint32_t>(x) * 73856093u) ^ (static_cast<std::uint32_t>(y) * 19349663u)) &
           static_cast<std::uint32_t>(heads_.size() - 1);
  }
  void insert(std::int32_t x, std::int32_t y, Slot slot);
  void erase(std::int32_t x, std::int32_t y, Slot slot);
  /// Doubles the number of buckets.
  void grow();

  Vec2 origin_m_;
  double cells_per_m_ = 1;
  std::vector<std::uint32_t> heads_;  // first entry of each bucket; the size is a power of two
  std::vector<Entry> entries_;
  std::uint32_t free_entry_ = kNone;  // head of the list of unused entries
  std::size_t used_entries_ = 0;
  std::vector<Box> boxes_;         // indexed by slot; NaN if unused
  std::vector<CellRange> ranges_;  // indexed by slot; empty if large or unused
  std::vector<Slot> large_;
};

}  // namespace sidestep::baselines
