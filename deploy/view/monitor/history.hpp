// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <string>

#include "common/time/time.hpp"

namespace sidestep {

/// The data that viewers get for one time: a frame and the panels.
struct Snapshot {
  Time at{};
  std::shared_ptr<const std::string> frame, panels;
};

/// Snapshots sorted by time, of bounded size. When full, it forgets either the oldest snapshots or, to keep
/// the whole duration, every other snapshot.
class History {
 public:
  enum class WhenFull : std::uint8_t { kForgetOldest, kThinOut };

  History(std::size_t max_bytes, WhenFull when_full) : max_bytes_(max_bytes), when_full_(when_full) {}

  /// Adds a snapshot. Ignores it if it is not later than the last one. A history that has been thinned out
  /// also ignores some later snapshots.
  void add(Snapshot snapshot);
  /// Adds the last snapshot of a run or of a recording. Ignores it only if it is not later than the one
  /// before.
  void add_last(Snapshot snapshot);
  bool empty() const { return snapshots_.empty(); }
  std::size_t size() const { return snapshots_.size(); }
  std::size_t bytes() const { return bytes_; }
  /// The first snapshot. Precondition of all functions below: the history is not empty.
  const Snapshot& first() const { return snapshots_.front(); }
  const Snapshot& last() const { return snapshots_.back(); }
  /// The last snapshot at or before a time; the first one if there is none.
  const Snapshot& at(Time time) const { return snapshots_[index_at(time)]; }
  /// The first snapshot at or after a time; the last one if there is none.
  const Snapshot& from(Time time) const;
  /// The snapshot `steps` after the one at a time (or before it, if negative), limited to the ends of the
  /// history.
  const Snapshot& stepped(Time time, int steps) const;

 private:
  bool is_later(const Snapshot& snapshot) const;
  void append(Snapshot snapshot);
  std::size_t index_at(Time time) const;
  void thin_out();

  std::size_t max_bytes_;
  WhenFull when_full_;
  std::deque<Snapshot> snapshots_;
  std::size_t bytes_ = 0;
  std::size_t stride_ = 1, skipped_ = 0;  // one in `stride_` of the added snapshots is kept
};

}  // namespace sidestep
