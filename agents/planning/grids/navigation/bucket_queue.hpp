// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace sidestep {

/// A priority queue whose entries are sorted by key only up to the width of a bucket (untidy priority queue:
/// Yatziv, Bartesaghi, Sapiro 2006). Within a bucket they come in the order in which they were added. Entries
/// are never removed before their turn; the caller skips entries whose keys have changed. Does not allocate
/// once warm.
///
/// A bucket has two lanes: one for entries without the flag kSecondLane, one for entries with it.
///
/// Buckets cover a window of keys. Entries beyond it wait in a list and are distributed when their turn
/// comes.
class BucketQueue {
 public:
  using Entry = std::uint32_t;
  static constexpr Entry kSecondLane = 0x80000000;

  void clear() {
    for (auto& lane : lanes_) lane.clear();
    later_.clear();
    current_ = 0;
    begin_ = 0;
  }

  bool is_before_current(float key) const { return bucket_of(key) < static_cast<float>(current_); }
  bool is_in_current(float key) const {
    const float bucket = bucket_of(key) - static_cast<float>(current_);
    return bucket >= 0 && bucket < 1;
  }

  /// Adds an entry whose key is not below the current bucket.
  void push(float key, Entry entry) {
    const float bucket = bucket_of(key);
    if (bucket < kBuckets) [[likely]]
      lanes_[lane_of(bucket, entry)].push_back(entry);
    else
      later_.push_back(entry);
  }

  /// Advances to the next bucket that has entries; false if there is none. `key_of` returns an entry's
  /// current key, which is infinite if the entry need not be visited any more.
  template <typename KeyOf>
  bool advance(const KeyOf& key_of) {
    while (true) {
      for (; current_ < kBuckets; ++current_)
        if (!lanes_[2 * current_].empty() || !lanes_[2 * current_ + 1].empty()) return true;
      if (later_.empty()) {
        current_ = kBuckets - 1;
        return false;
      }
      distribute(kNever, key_of);
    }
  }

  /// Moves the current bucket back if this key, which will be added, is below the current bucket.
  template <typename KeyOf>
  void rewind(float key, const KeyOf& key_of) {
    if (key >= begin_) {
      current_ = static_cast<std::uint32_t>(std::min(static_cast<float>(current_), bucket_of(key)));
      return;
    }
    for (auto& lane : lanes_) {
      later_.insert(later_.end(), lane.begin(), lane.end());
      lane.clear();
    }
    distribute(key, key_of);
  }

  /// One lane of the current bucket. It grows when entries are pushed to it.
  std::vector<Entry>& first_lane() { return lanes_[2 * current_]; }
  std::vector<Entry>& second_lane() { return lanes_[2 * current_ + 1]; }

 private:
  static constexpr std::uint32_t kBuckets = 1024;
  static constexpr float kPerUnit = 4;  // reciprocal of a bucket's width
  static constexpr float kNever = std::numeric_limits<float>::infinity();

  /// The integer part is the key's bucket in the current window. Keys of later windows give larger numbers.
  float bucket_of(float key) const { return (key - begin_) * kPerUnit; }

  static std::uint32_t lane_of(float bucket, Entry entry) {
    return 2 * static_cast<std::uint32_t>(bucket) + (entry >= kSecondLane);
  }

  /// Starts a window at this key, or at the lowest key in the list.
  template <typename KeyOf>
  void distribute(float begin, const KeyOf& key_of) {
    for (const Entry entry : later_) begin = std::min(begin, key_of(entry));
    begin_ = begin < kNever ? begin : 0;
    current_ = 0;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < later_.size(); ++i) {
      const float key = key_of(later_[i]);
      if (bucket_of(key) < kBuckets)
        lanes_[lane_of(bucket_of(key), later_[i])].push_back(later_[i]);
      else if (key < kNever)
        later_[kept++] = later_[i];
    }
    later_.resize(kept);
  }

  std::array<std::vector<Entry>, 2 * kBuckets> lanes_;
  std::vector<Entry> later_;
  std::uint32_t current_ = 0;
  float begin_ = 0;  // lowest key of the window
};

}  // namespace sidestep
