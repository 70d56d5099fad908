// SPDX-License-Identifier: Apache-2.0
#include "common/process/network_faults.hpp"

#include <fmt/core.h>

#include "common/messaging/impairment.hpp"
#include "common/messaging/senders.hpp"

namespace sidestep {
namespace {

double milliseconds(Duration d) { return to_seconds(d) * 1e3; }

std::string in_words(const LinkQuality& quality) {
  if (quality.is_cut) return "nothing arrives";
  if (quality == kUntouchedLink) return "everything arrives as it comes";
  return fmt::format(
      "{:.4g} % lost in bursts of {:.4g}, {:.4g} % doubled, {:.4g} to {:.4g} ms late, {:.4g} on average",
      100 * quality.loss, quality.mean_burst, 100 * quality.duplicate, milliseconds(quality.delay_min),
      milliseconds(quality.delay_max), milliseconds(quality.delay_mean));
}

}  // namespace

void take_network_faults(DdsBus& bus, std::uint32_t target, const std::string& name) {
  bus.subscribe(topics::kNetworkFault, std::function([&bus, target, name](const msg::NetworkFault& order) {
                  if (order.target() != target && order.target() != kEveryProcess) return;
                  const auto quality = link_quality_from(order);
                  fmt::print(stderr, "{}: network fault: {}\n", name,
                             quality ? in_words(*quality) : "an order that makes no sense, ignored");
                  // Every process has a seed of its own, or all would lose the same.
                  if (quality) bus.impair(*quality, order.seed() ^ (target * 0x9e3779b97f4a7c15ULL));
                }));
}

}  // namespace sidestep
