// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "common/time/time.hpp"

namespace sidestep {

/// One revolution of a timing wheel: kCount slots for consecutive slot numbers, addressed modulo kCount.
template <typename Entry, std::int64_t kCount>
class Wheel {
 public:
  void add(std::int64_t slot, const Entry& entry) {
    const std::size_t index = index_of(slot);
    slots_[index].push_back(entry);
    used_[index / 64] |= std::uint64_t{1} << (index % 64);
  }
  /// The first slot in [from, to) that has entries, or `to` if all are empty. Precondition: at most kCount
  /// slots.
  std::int64_t next_used(std::int64_t from, std::int64_t to) const {
    while (from < to) {
      const std::size_t index = index_of(from);
      const std::uint64_t word = used_[index / 64] >> (index % 64);
      if (word != 0) return std::min(to, from + std::countr_zero(word));
      from += 64 - static_cast<std::int64_t>(index % 64);
    }
    return to;
  }
  /// Moves the slot's entries into `entries`. Precondition: `entries` is empty; its memory is kept for the
  /// slot.
  void take(std::int64_t slot, std::vector<Entry>& entries) {
    const std::size_t index = index_of(slot);
    std::swap(entries, slots_[index]);
    used_[index / 64] &= ~(std::uint64_t{1} << (index % 64));
  }

 private:
  static std::size_t index_of(std::int64_t slot) { return static_cast<std::size_t>(slot & (kCount - 1)); }

  std::vector<std::vector<Entry>> slots_ = std::vector<std::vector<Entry>>(kCount);
  std::vector<std::uint64_t> used_ = std::vector<std::uint64_t>(kCount / 64, 0);
};

/// Queue of events ordered by (time, order of insertion), on hierarchical timing wheels (Varghese, Lauck
/// 1987). The first wheel covers 2 ms in 1 µs slots; a slot is sorted when its time comes. Each slot of the
/// second wheel covers one revolution of the first. Later events wait in a heap. The cost hardly depends on
/// the number of events. A queue that has reached its maximum size allocates nothing.
template <typename Payload>
class EventQueue {
 public:
  bool is_empty() const { return count_ == 0; }

  void push(Time when, const Payload& payload) {
    ++count_;
    add(Entry{to_ns(when), order_++, payload});
  }

  /// The time of the next event. Precondition: not empty.
  Time next_time() {
    load_due();
    return time_from_ns(due_.back().when_ns);
  }

  /// Removes the next event. Precondition: not empty.
  Payload pop() {
    load_due();
    const Payload payload = due_.back().payload;
    due_.pop_back();
    --count_;
    return payload;
  }

  /// The event `distance` places behind the next event if it is in the same slot, otherwise null. For
  /// prefetching.
  const Payload* peek(std::size_t distance) const {
    return due_.size() > distance ? &due_[due_.size() - 1 - distance].payload : nullptr;
  }

 private:
  static constexpr int kSlotBits = 10;        // log2 of the length of a slot in ns
  static constexpr int kRevolutionBits = 11;  // log2 of the number of slots in a revolution
  static constexpr std::int64_t kRevolutions = 256;

  struct Entry {
    std::int64_t when_ns;
    std::uint64_t order;
    Payload payload;
  };
  struct Later {
    bool operator()(const Entry& a, const Entry& b) const {
      return a.when_ns != b.when_ns ? a.when_ns > b.when_ns : a.order > b.order;
    }
  };

  static std::int64_t slot_of(const Entry& entry) { return entry.when_ns >> kSlotBits; }

  void add(const Entry& entry) {
    const std::int64_t slot = slot_of(entry), revolution = slot >> kRevolutionBits;
    if (slot <= slot_) {
      due_.insert(std::ranges::upper_bound(due_, entry, Later{}), entry);
    } else if (revolution == revolution_) {
      slots_.add(slot, entry);
    } else if (revolution < revolution_ + kRevolutions) {
      revolutions_.add(revolution, entry);
    } else {
      later_.push_back(entry);
      std::ranges::push_heap(later_, Later{});
    }
  }

  /// If no event is due, advances to the next slot that has events and loads its events.
  void load_due() {
    if (!due_.empty()) return;
    if (next_slot() > last_slot()) begin_next_revolution();
    slot_ = next_slot();
    slots_.take(slot_, due_);
    if (due_.size() > 1) std::ranges::sort(due_, Later{});
  }

  std::int64_t last_slot() const { return ((revolution_ + 1) << kRevolutionBits) - 1; }
  /// The next slot of this revolution that has events; last_slot() + 1 if there is none.
  std::int64_t next_slot() const { return slots_.next_used(slot_ + 1, last_slot() + 1); }

  /// Advances to the next revolution that has events, spreads its events over the first wheel, and moves
  /// events from the heap to the wheels if the wheels now cover their times.
  void begin_next_revolution() {
    const std::int64_t far = later_.empty() ? INT64_MAX : slot_of(later_.front()) >> kRevolutionBits;
    const std::int64_t end = revolution_ + kRevolutions, near = revolutions_.next_used(revolution_ + 1, end);
    revolution_ = near < end ? std::min(near, far) : far;
    slot_ = (revolution_ << kRevolutionBits) - 1;
    revolutions_.take(revolution_, arriving_);
    for (const Entry& entry : arriving_) slots_.add(slot_of(entry), entry);
    arriving_.clear();
    while (!later_.empty() && slot_of(later_.front()) >> kRevolutionBits < revolution_ + kRevolutions) {
      std::ranges::pop_heap(later_, Later{});
      add(later_.back());
      later_.pop_back();
    }
  }

  std::size_t count_ = 0;
  std::uint64_t order_ = 0;
  std::int64_t revolution_ = INT64_MIN >> (kSlotBits + kRevolutionBits);
  std::int64_t slot_ = revolution_ << kRevolutionBits;      // the slot that due_ was loaded from
  std::vector<Entry> due_;                                  // latest event first
  Wheel<Entry, std::int64_t{1} << kRevolutionBits> slots_;  // slots of the current revolution
  Wheel<Entry, kRevolutions> revolutions_;                  // the revolutions after the current one
  std::vector<Entry> arriving_;                             // scratch of begin_next_revolution()
  std::vector<Entry> later_;                                // a heap
};

}  // namespace sidestep
