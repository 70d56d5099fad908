// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/comparable_stamps.hpp"

#include <algorithm>

namespace sidestep {

void ComparableStamps::record(std::uint64_t channel, const msg::Header& header) {
  const auto [entry, is_new] = runs_.try_emplace({header.sender(), header.incarnation()});
  if (is_new && runs_.size() > kMaxRuns) {
    const auto used = [](const auto& known) { return known.second.used; };
    entry->second.used = ++uses_;
    runs_.erase(std::ranges::min_element(runs_, {}, used));
  }
  Run& run = entry->second;
  run.used = ++uses_;
  if (run.newest.size() >= kMaxChannels && !run.newest.contains(channel))
    run.newest.erase(run.newest.begin());
  Newest& newest = run.newest[channel];
  const std::uint64_t number = header.message_number();
  const std::int64_t stamp_ns = header.stamp_ns();
  if (newest.number == 0 || number == newest.number) {
    newest = {number, stamp_ns};
    return;
  }
  run.was_set_back |= number > newest.number ? stamp_ns < newest.stamp_ns : stamp_ns > newest.stamp_ns;
  if (number > newest.number) newest = {number, stamp_ns};
}

bool ComparableStamps::are_in_order(std::uint32_t sender, Incarnation incarnation) const {
  const auto run = runs_.find({sender, incarnation});
  return run != runs_.end() && !run->second.was_set_back;
}

}  // namespace sidestep
