// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/impaired_link.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {

Duration sample_delay(const LinkQuality& quality, Rng& rng) {
  const double mean_s = std::max(0.0, to_seconds(quality.delay_mean - quality.delay_min));
  const Duration above = from_seconds(-mean_s * std::log(1 - rng.uniform()));
  return std::min(quality.delay_min + above, std::max(quality.delay_min, quality.delay_max));
}

bool ImpairedLink::draw_loss(const LinkQuality& quality, Rng& rng) {
  if (quality.is_cut || quality.loss >= 1) return true;
  // Gilbert model: there are two states, and every message sent in the losing state is lost. The losing state
  // lasts mean_burst messages on average. Its probability of entry is chosen so that the fraction `loss` of
  // all messages falls into it.
  const double leave = 1 / std::max(1.0, quality.mean_burst);
  const double enter = std::min(1.0, leave * quality.loss / (1 - quality.loss));
  is_losing_ = is_losing_ ? !rng.chance(leave) : rng.chance(enter);
  return is_losing_;
}

MessageCopies ImpairedLink::send(const LinkQuality& quality, Rng& rng) {
  MessageCopies copies;
  if (draw_loss(quality, rng)) return copies;
  copies.delays[copies.count++] = sample_delay(quality, rng);
  if (rng.chance(quality.duplicate)) copies.delays[copies.count++] = sample_delay(quality, rng);
  return copies;
}

}  // namespace sidestep
