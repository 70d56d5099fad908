// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/monitor/history.hpp"

#include <algorithm>
#include <utility>

namespace sidestep {
namespace {

/// Does not count panels, which are small and shared by many snapshots.
std::size_t size_of(const Snapshot& snapshot) { return snapshot.frame->size() + sizeof(Snapshot); }

}  // namespace

void History::add(Snapshot snapshot) {
  if (!is_later(snapshot) || ++skipped_ < stride_) return;
  skipped_ = 0;
  append(std::move(snapshot));
  if (when_full_ == WhenFull::kThinOut) {
    if (bytes_ > max_bytes_) thin_out();
    return;
  }
  while (bytes_ > max_bytes_ && snapshots_.size() > 1) {
    bytes_ -= size_of(snapshots_.front());
    snapshots_.pop_front();
  }
}

void History::add_last(Snapshot snapshot) {
  if (is_later(snapshot)) append(std::move(snapshot));
}

bool History::is_later(const Snapshot& snapshot) const {
  return snapshots_.empty() || snapshot.at > snapshots_.back().at;
}

void History::append(Snapshot snapshot) {
  bytes_ += size_of(snapshot);
  snapshots_.push_back(std::move(snapshot));
}

void History::thin_out() {
  std::deque<Snapshot> kept;
  bytes_ = 0;
  for (std::size_t i = 0; i < snapshots_.size(); i += 2) {
    bytes_ += size_of(snapshots_[i]);
    kept.push_back(std::move(snapshots_[i]));
  }
  snapshots_ = std::move(kept);
  stride_ *= 2;
}

std::size_t History::index_at(Time time) const {
  const auto after = std::ranges::upper_bound(snapshots_, time, {}, &Snapshot::at);
  return after == snapshots_.begin() ? 0 : static_cast<std::size_t>(after - snapshots_.begin()) - 1;
}

const Snapshot& History::from(Time time) const {
  const auto found = std::ranges::lower_bound(snapshots_, time, {}, &Snapshot::at);
  return found == snapshots_.end() ? last() : *found;
}

const Snapshot& History::stepped(Time time, int steps) const {
  const auto index = static_cast<std::ptrdiff_t>(index_at(time)) + steps;
  const auto last = static_cast<std::ptrdiff_t>(snapshots_.size()) - 1;
  return snapshots_[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(index, 0, last))];
}

}  // namespace sidestep
