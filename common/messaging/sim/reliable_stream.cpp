// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/sim/reliable_stream.hpp"

#include <algorithm>

namespace sidestep {

bool ReliableStream::update(const Reachability& reachability, Time now) {
  const bool is_forgotten = reachability.is_forgotten(now);
  if (is_forgotten || reachability.reconnected_at > begin_) {
    begin_ = is_forgotten ? now : reachability.reconnected_at;
    is_rediscovery_ = true;
    is_matched_ = false;
  }
  if (is_matched_ || is_forgotten) return is_matched_;
  const Time heard_from = std::max(begin_, reachability.heard_from);
  const Duration first_delay = is_rediscovery_ ? delays_.anew : delays_.at_first;
  const Duration delay = heard_from > begin_ ? delays_.anew : first_delay;
  is_matched_ = begin_ == Time::min() || begin_ + first_delay <= reachability.last_silent_from ||
                heard_from + delay <= std::min(now, reachability.silent_from);
  return is_matched_;
}

std::optional<ReliableStream::Sample> ReliableStream::overwrite(const CdrKey& key) {
  const auto is_kept = [&](const Sample& sample) { return sample.is_in_history && sample.key == key; };
  if (static_cast<std::size_t>(std::ranges::count_if(waiting_, is_kept)) <= kEventDepth) return {};
  const auto oldest = std::ranges::find_if(waiting_, is_kept);
  oldest->is_in_history = false;
  if (oldest->has_arrived) return {};
  const Sample lost = *oldest;
  waiting_.erase(oldest);
  return lost;
}

std::optional<ReliableStream::Sample> ReliableStream::pop_arrived() {
  if (waiting_.empty() || !waiting_.front().has_arrived) return {};
  const Sample first = waiting_.front();
  waiting_.pop_front();
  return first;
}

}  // namespace sidestep
