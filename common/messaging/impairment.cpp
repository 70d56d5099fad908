// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/impairment.hpp"

namespace sidestep {
namespace {

constexpr std::int64_t kMaxDelay_ns = 10'000'000'000;
constexpr double kMaxMeanBurst = 1e6;
constexpr std::size_t kMaxSenders = 4096;

// False if the value is NaN.
bool is_within(double value, double low, double high) { return value >= low && value <= high; }

}  // namespace

std::optional<LinkQuality> link_quality_from(const msg::NetworkFault& fault) {
  const bool is_valid = is_within(fault.loss(), 0, 1) && is_within(fault.mean_burst(), 1, kMaxMeanBurst) &&
                        is_within(fault.duplicate(), 0, 1) && fault.delay_min_ns() >= 0 &&
                        fault.delay_mean_ns() >= fault.delay_min_ns() &&
                        fault.delay_max_ns() >= fault.delay_mean_ns() && fault.delay_max_ns() <= kMaxDelay_ns;
  if (!is_valid) return std::nullopt;
  return LinkQuality{fault.loss(),
                     fault.mean_burst(),
                     fault.duplicate(),
                     Duration{fault.delay_min_ns()},
                     Duration{fault.delay_mean_ns()},
                     Duration{fault.delay_max_ns()},
                     fault.is_cut()};
}

void Impairment::set(const LinkQuality& quality, std::uint64_t seed) {
  const std::lock_guard lock(mutex_);
  quality_ = quality;
  rng_ = Rng(seed);
  links_.clear();
}

MessageCopies Impairment::receive(const SenderId& sender) {
  const std::lock_guard lock(mutex_);
  if (quality_ == kUnimpairedLink) return {{}, 1};
  if (links_.size() >= kMaxSenders) links_.clear();
  return links_[sender].send(quality_, rng_);
}

}  // namespace sidestep
