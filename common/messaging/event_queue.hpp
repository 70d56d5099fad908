// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "common/time/time.hpp"

namespace sidestep {

/// What is to happen when, in the order of (time, order of being put in). A timing wheel (Varghese, Lauck
/// 1987) holds what is near, each of its slots what happens in one microsecond or so, put in order when its
/// time comes; what is farther ahead waits in a heap. Costs hardly depend on how many events are waiting, and
/// nothing is allocated once warm.
template <typename Payload>
class EventQueue {
 public:
  bool is_empty() const { return count_ == 0; }

  void put(Time when, const Payload& payload) {
    const Entry entry{to_ns(when), order_++, payload};
    ++count_;
    if (slot_of(entry) <= current_) {
      due_.insert(std::ranges::upper_bound(due_, entry, Later{}), entry);
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
  static constexpr int kSlotBits = 10;                           // of a time in ns, which make up a slot
  static constexpr std::int64_t kSlots = std::int64_t{1} << 11;  // 2 ms

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
  static std::size_t index_of(std::int64_t slot) { return static_cast<std::size_t>(slot & (kSlots - 1)); }

  void hang(const Entry& entry) {
    const std::size_t index = index_of(slot_of(entry));
    slots_[index].push_back(entry);
    used_[index / 64] |= std::uint64_t{1} << (index % 64);
  }

  /// Goes on to the next slot that has something, and takes over that and what has come near from the heap.
  void find_due() {
    if (!due_.empty()) return;
    const std::int64_t far = far_.empty() ? INT64_MAX : slot_of(far_.front());
    current_ = std::min(next_used(), far);
    const std::size_t index = index_of(current_);
    std::swap(due_, slots_[index]);
    used_[index / 64] &= ~(std::uint64_t{1} << (index % 64));
    while (!far_.empty() && slot_of(far_.front()) < current_ + kSlots) {
      std::ranges::pop_heap(far_, Later{});
      if (slot_of(far_.back()) == current_)
        due_.push_back(far_.back());
      else
        hang(far_.back());
      far_.pop_back();
    }
    std::ranges::sort(due_, Later{});
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
  std::vector<Entry> due_;                // the next at the end
  std::vector<Entry> far_;                // a heap
  std::vector<std::vector<Entry>> slots_ = std::vector<std::vector<Entry>>(kSlots);
  std::vector<std::uint64_t> used_ = std::vector<std::uint64_t>(kSlots / 64, 0);
};

}  // namespace sidestep
