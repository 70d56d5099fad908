// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/sim_links.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

Duration draw_delay(const LinkQuality& quality, Rng& rng) {
  const double mean_s = std::max(0.0, to_seconds(quality.delay_mean - quality.delay_min));
  const Duration above = from_seconds(-mean_s * std::log(1 - rng.uniform()));
  return std::min(quality.delay_min + above, std::max(quality.delay_min, quality.delay_max));
}

}  // namespace

void SimLinks::set(ProcessId from, ProcessId to, const LinkQuality& quality) {
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
  link.quality = quality;
  link.is_set = true;
}

const LinkQuality* SimLinks::find(ProcessId from, ProcessId to) const {
  if (from >= width_ || to >= width_ || !at(from, to).is_set) return nullptr;
  return &at(from, to).quality;
}

bool SimLinks::is_lost(Link& link, Rng& rng) const {
  const LinkQuality& quality = link.quality;
  if (quality.is_cut || quality.loss >= 1) return true;
  // Two states; in the losing one every message is lost. It is left after mean_burst messages on average,
  // and entered so often that `loss` of all messages fall into it.
  const double leave = 1 / std::max(1.0, quality.mean_burst);
  const double enter = std::min(1.0, leave * quality.loss / (1 - quality.loss));
  link.is_losing = link.is_losing ? !rng.chance(leave) : rng.chance(enter);
  return link.is_losing;
}

Copies SimLinks::send(ProcessId from, ProcessId to, Rng& rng) {
  Link& link = links_[from * width_ + to];
  Copies copies;
  if (is_lost(link, rng)) return copies;
  copies.delays[copies.count++] = draw_delay(link.quality, rng);
  if (rng.chance(link.quality.duplicate)) copies.delays[copies.count++] = draw_delay(link.quality, rng);
  return copies;
}

Duration SimLinks::delay(ProcessId from, ProcessId to, Rng& rng) const {
  return draw_delay(at(from, to).quality, rng);
}

}  // namespace sidestep
