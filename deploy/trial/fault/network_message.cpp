// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/fault/network_message.hpp"

namespace sidestep {

msg::NetworkFault encode(const LinkQuality& quality, std::uint32_t target, std::uint64_t seed) {
  msg::NetworkFault fault;
  fault.target(target);
  fault.seed(seed);
  fault.loss(quality.loss);
  fault.mean_burst(quality.mean_burst);
  fault.duplicate(quality.duplicate);
  fault.delay_min_ns(quality.delay_min.count());
  fault.delay_mean_ns(quality.delay_mean.count());
  fault.delay_max_ns(quality.delay_max.count());
  fault.is_cut(quality.is_cut);
  return fault;
}

}  // namespace sidestep
