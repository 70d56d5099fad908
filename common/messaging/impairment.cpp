// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/impairment.hpp"

namespace sidestep {
namespace {

constexpr std::int64_t kLongestDelay_ns = 10'000'000'000;
constexpr double kLongestBurst = 1e6;
constexpr std::size_t kMostSenders = 4096;

/// False for NaN too.
bool is_within(double value, double low, double high) { return value >= low && value <= high; }

}  // namespace

std::optional<LinkQuality> link_quality_from(const msg::NetworkFault& order) {
  const bool is_sound = is_within(order.loss(), 0, 1) && is_within(order.mean_burst(), 1, kLongestBurst) &&
                        is_within(order.duplicate(), 0, 1) && order.delay_min_ns() >= 0 &&
                        order.delay_mean_ns() >= order.delay_min_ns() &&
                        order.delay_max_ns() >= order.delay_mean_ns() &&
                        order.delay_max_ns() <= kLongestDelay_ns;
  if (!is_sound) return std::nullopt;
  return LinkQuality{order.loss(),
                     order.mean_burst(),
                     order.duplicate(),
                     Duration{order.delay_min_ns()},
                     Duration{order.delay_mean_ns()},
                     Duration{order.delay_max_ns()},
                     order.is_cut()};
}

void Impairment::set(const LinkQuality& quality, std::uint64_t seed) {
  const std::lock_guard lock(mutex_);
  quality_ = quality;
  rng_ = Rng(seed);
  links_.clear();
}

Copies Impairment::receive(const SenderId& sender) {
  const std::lock_guard lock(mutex_);
  if (quality_ == kUntouchedLink) return {{}, 1};
  if (links_.size() >= kMostSenders) links_.clear();
  return links_[sender].send(quality_, rng_);
}

}  // namespace sidestep
