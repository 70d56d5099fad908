// SPDX-License-Identifier: Apache-2.0
#include "common/process/network_faults.hpp"

#include <fmt/core.h>

#include "common/log/log.hpp"
#include "common/messaging/impairment.hpp"
#include "common/protocol/senders.hpp"

namespace sidestep {
namespace {

double milliseconds(Duration d) { return to_seconds(d) * 1e3; }

std::string describe(const LinkQuality& quality) {
  if (quality.is_cut) return "all messages are dropped";
  if (quality == kUnimpairedLink) return "none";
  return fmt::format(
      "{:.4g} % lost in bursts of {:.4g}, {:.4g} % duplicated, delayed by {:.4g} to {:.4g} ms, {:.4g} ms on "
      "average",
      100 * quality.loss, quality.mean_burst, 100 * quality.duplicate, milliseconds(quality.delay_min),
      milliseconds(quality.delay_max), milliseconds(quality.delay_mean));
}

}  // namespace

void apply_network_faults(DdsBus& bus, std::uint32_t target) {
  bus.subscribe(topics::kNetworkFault, std::function([&bus, target](const msg::NetworkFault& fault) {
                  if (fault.target() != target && fault.target() != kEveryProcess) return;
                  const auto quality = link_quality_from(fault);
                  log(LogLevel::kWarning,
                      "network fault: " + (quality ? describe(*quality) : "invalid, ignored"));
                  if (!quality) bus.count_drop(DropReason::kMalformedNetworkFault);
                  // Each process has its own seed, so that losses are independent.
                  if (quality) bus.impair(*quality, fault.seed() ^ (target * 0x9e3779b97f4a7c15ULL));
                }));
}

}  // namespace sidestep
