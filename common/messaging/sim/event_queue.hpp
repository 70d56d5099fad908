// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "common/time/time.hpp"

namespace sidestep {

/// One round of a timing wheel: places for consecutive numbers, found again by the number.
template <typename Entry, std::int64_t kCount>
class Wheel {
 public:
  void put(std::int64_t number, const Entry& entry) {
    const std::size_t index = index_of(number);
    places_[index].push_back(entry);
    used_[index / 64] |= std::uint64_t{1} << (index % 64);
  }
  /// The first number from `from` on, and before `to`, that has something; `to` when none has. At most a
  /// round is looked at.
  std::int64_t next(std::int64_t from, std::int64_t to) const {
    while (from < to) {
      const std::size_t index = index_of(from);
      const std::uint64_t word = used_[index / 64] >> (index % 64);
      if (word != 0) return std::min(to, from + std::countr_zero(word));
      from += 64 - static_cast<std::int64_t>(index % 64);
    }
    return to;
  }
  /// What the number has is swapped for what `entries` holds, nothing.
  void take(std::int64_t number, std::vector<Entry>& entries) {
    const std::size_t index = index_of(number);
    std::swap(entries, places_[index]);
    used_[index / 64] &= ~(std::uint64_t{1} << (index % 64));
  }

 private:
  static std::size_t index_of(std::int64_t number) { return static_cast<std::size_t>(number & (kCount - 1)); }

  std::vector<std::vector<Entry>> places_ = std::vector<std::vector<Entry>>(kCount);
  std::vector<std::uint64_t> used_ = std::vector<std::uint64_t>(kCount / 64, 0);
};

/// What is to happen when, in the order of (time, order of being put in). Timing wheels (Varghese, Lauck
/// 1987): one has a slot for each microsecond or so of the turn of two milliseconds that it is, put in order
/// when its time comes; another one has the turns that follow; what is farther ahead waits in a heap. Costs
/// hardly depend on how many events are waiting, and nothing is allocated once warm.
template <typename Payload>
class EventQueue {
 public:
  bool is_empty() const { return count_ == 0; }

  void put(Time when, const Payload& payload) {
    ++count_;
    put(Entry{to_ns(when), order_++, payload});
  }

  /// The time of the next event. Precondition: not empty.
  Time next_time() {
    find_due();
    return time_from_ns(due_.back().when_ns);
  }

  /// Takes the next event. Precondition: not empty.
  Payload take() {
    find_due();
    const Payload payload = due_.back().payload;
    due_.pop_back();
    --count_;
    return payload;
  }

  /// What comes so many events after the next one, if that is soon: for fetching what it needs.
  const Payload* ahead(std::size_t events) const {
    return due_.size() > events ? &due_[due_.size() - 1 - events].payload : nullptr;
  }

 private:
  static constexpr int kSlotBits = 10;  // of a time in ns, which make up a slot
  static constexpr int kTurnBits = 11;  // of a slot's number, which make up a turn
  static constexpr std::int64_t kTurns = 256;

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

  void put(const Entry& entry) {
    const std::int64_t slot = slot_of(entry), turn = slot >> kTurnBits;
    if (slot <= slot_) {
      due_.insert(std::ranges::upper_bound(due_, entry, Later{}), entry);
    } else if (turn == turn_) {
      slots_.put(slot, entry);
    } else if (turn < turn_ + kTurns) {
      turns_.put(turn, entry);
    } else {
      far_.push_back(entry);
      std::ranges::push_heap(far_, Later{});
    }
  }

  /// Goes on to the next slot that has something, and takes that over.
  void find_due() {
    if (!due_.empty()) return;
    if (next_slot() > last_slot()) begin_next_turn();
    slot_ = next_slot();
    slots_.take(slot_, due_);
    if (due_.size() > 1) std::ranges::sort(due_, Later{});
  }

  std::int64_t last_slot() const { return ((turn_ + 1) << kTurnBits) - 1; }
  /// The next slot of this turn that has something; beyond the last one when none has.
  std::int64_t next_slot() const { return slots_.next(slot_ + 1, last_slot() + 1); }

  /// Goes on to just before the next turn that has something, and takes over that and what has come near from
  /// the heap.
  void begin_next_turn() {
    const std::int64_t far = far_.empty() ? INT64_MAX : slot_of(far_.front()) >> kTurnBits;
    const std::int64_t end = turn_ + kTurns, near = turns_.next(turn_ + 1, end);
    turn_ = near < end ? std::min(near, far) : far;
    slot_ = (turn_ << kTurnBits) - 1;
    turns_.take(turn_, arriving_);
    for (const Entry& entry : arriving_) slots_.put(slot_of(entry), entry);
    arriving_.clear();
    while (!far_.empty() && slot_of(far_.front()) >> kTurnBits < turn_ + kTurns) {
      std::ranges::pop_heap(far_, Later{});
      put(far_.back());
      far_.pop_back();
    }
  }

  std::size_t count_ = 0;
  std::uint64_t order_ = 0;
  std::int64_t turn_ = INT64_MIN >> (kSlotBits + kTurnBits);
  std::int64_t slot_ = turn_ << kTurnBits;            // of what is due
  std::vector<Entry> due_;                            // the next at the end
  Wheel<Entry, std::int64_t{1} << kTurnBits> slots_;  // of this turn
  Wheel<Entry, kTurns> turns_;                        // that follow
  std::vector<Entry> arriving_;                       // of the turn that begins
  std::vector<Entry> far_;                            // a heap
};

}  // namespace sidestep
