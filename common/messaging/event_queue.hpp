// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "common/messaging/pool.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// What is to happen when, in the order of (time, order of being put in). A timing wheel (Varghese, Lauck
/// 1987) holds what is near: each of its slots is a list of what happens in one microsecond or so, put in
/// order when its time comes; what is farther ahead waits in a heap. Costs hardly depend on how many events
/// are waiting, and nothing is allocated once warm.
template <typename Payload>
class EventQueue {
 public:
  bool is_empty() const { return count_ == 0; }

  /// Precondition: not before the time of what was taken last.
  void put(Time when, Payload payload) {
    const std::uint32_t place = places_.put({std::move(payload), {}, kNone});
    const Entry entry{to_ns(when), order_++, place};
    ++count_;
    if (slot_of(entry) <= current_) {
      due_.push_back(entry);
      std::ranges::push_heap(due_, Later{});
    } else if (slot_of(entry) < current_ + kSlots) {
      hang(entry);
    } else {
      far_.push_back(entry);
      std::ranges::push_heap(far_, Later{});
    }
  }

  /// The time of the next event. Precondition: not empty.
  Time next_time() {
    find_due();
    return time_from_ns(due_.front().when_ns);
  }

  /// Takes the next event. Precondition: not empty.
  Payload take() {
    find_due();
    std::ranges::pop_heap(due_, Later{});
    const std::uint32_t place = due_.back().place;
    due_.pop_back();
    --count_;
    return places_.take(place).payload;
  }

 private:
  static constexpr int kSlotBits = 10;                           // of a time in ns, which make up a slot
  static constexpr std::int64_t kSlots = std::int64_t{1} << 15;  // 34 ms
  static constexpr std::uint32_t kNone = UINT32_MAX;

  struct Entry {
    std::int64_t when_ns;
    std::uint64_t order;
    std::uint32_t place;
  };
  struct Later {
    bool operator()(const Entry& a, const Entry& b) const {
      return a.when_ns != b.when_ns ? a.when_ns > b.when_ns : a.order > b.order;
    }
  };
  struct Place {
    Payload payload;
    Entry entry;
    std::uint32_t next;  // in the same slot
  };

  static std::int64_t slot_of(const Entry& entry) { return entry.when_ns >> kSlotBits; }
  static std::size_t index_of(std::int64_t slot) { return static_cast<std::size_t>(slot & (kSlots - 1)); }

  void hang(const Entry& entry) {
    const std::size_t index = index_of(slot_of(entry));
    places_[entry.place].entry = entry;
    places_[entry.place].next = heads_[index];
    heads_[index] = entry.place;
    used_[index / 64] |= std::uint64_t{1} << (index % 64);
  }

  /// Goes on to the next slot that has something, and takes it and what has come near from the heap over.
  void find_due() {
    if (!due_.empty()) return;
    const std::int64_t far = far_.empty() ? INT64_MAX : slot_of(far_.front());
    current_ = std::min(next_used(), far);
    const std::size_t index = index_of(current_);
    for (std::uint32_t place = heads_[index]; place != kNone; place = places_[place].next) {
      due_.push_back(places_[place].entry);
    }
    heads_[index] = kNone;
    used_[index / 64] &= ~(std::uint64_t{1} << (index % 64));
    while (!far_.empty() && slot_of(far_.front()) < current_ + kSlots) {
      std::ranges::pop_heap(far_, Later{});
      if (slot_of(far_.back()) == current_)
        due_.push_back(far_.back());
      else
        hang(far_.back());
      far_.pop_back();
    }
    std::ranges::make_heap(due_, Later{});
  }

  /// The next slot of the wheel that has something; INT64_MAX when none has.
  std::int64_t next_used() const {
    const std::int64_t from = current_ + 1;
    for (std::int64_t seen = 0; seen < kSlots;) {
      const std::size_t index = index_of(from + seen);
      const std::uint64_t word = used_[index / 64] >> (index % 64);
      if (word != 0) return from + seen + std::countr_zero(word);
      seen += 64 - static_cast<std::int64_t>(index % 64);
    }
    return INT64_MAX;
  }

  std::size_t count_ = 0;
  std::uint64_t order_ = 0;
  std::int64_t current_ = INT64_MIN / 2;  // the slot of what is due
  std::vector<Entry> due_, far_;          // heaps
  Pool<Place> places_;
  std::vector<std::uint32_t> heads_ = std::vector<std::uint32_t>(kSlots, kNone);
  std::vector<std::uint64_t> used_ = std::vector<std::uint64_t>(kSlots / 64, 0);
};

}  // namespace sidestep
