// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/sim/links.hpp"

#include <algorithm>

namespace sidestep {
namespace {

bool is_silent(const LinkQuality& quality) { return quality.is_cut || quality.loss >= 1; }

}  // namespace

void SimLinks::set(ProcessId from, ProcessId to, const LinkQuality& quality, Time now) {
  const std::size_t needed = std::max(from, to) + std::size_t{1};
  if (needed > width_) {
    std::vector<Link> wider(needed * needed);
    for (std::size_t row = 0; row < width_; ++row) {
      std::copy_n(links_.begin() + static_cast<std::ptrdiff_t>(row * width_), width_,
                  wider.begin() + static_cast<std::ptrdiff_t>(row * needed));
    }
    links_ = std::move(wider);
    width_ = needed;
  }
  Link& link = links_[from * width_ + to];
  if (is_silent(link.quality) && !is_silent(quality)) link.reachability.on_silence_end(now);
  if (is_silent(quality)) link.reachability.silence(now);
  link.quality = quality;
  link.is_set = true;
}

const LinkQuality* SimLinks::find(ProcessId from, ProcessId to) const {
  if (from >= width_ || to >= width_ || !at(from, to).is_set) return nullptr;
  return &at(from, to).quality;
}

MessageCopies SimLinks::send(ProcessId from, ProcessId to, Rng& rng) {
  Link& link = links_[from * width_ + to];
  return link.impaired.send(link.quality, rng);
}

Duration SimLinks::delay(ProcessId from, ProcessId to, Rng& rng) const {
  return sample_delay(at(from, to).quality, rng);
}

Reachability SimLinks::reachability(ProcessId a, ProcessId b) const {
  Reachability reachability;
  if (find(a, b)) reachability = at(a, b).reachability;
  return find(b, a) ? both(reachability, at(b, a).reachability) : reachability;
}

}  // namespace sidestep
