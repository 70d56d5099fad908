// SPDX-License-Identifier: Apache-2.0
#include "common/process/host_clock_watch.hpp"

#include <string_view>
#include <utility>

namespace sidestep {

HostClockWatch::HostClockWatch(Bus& bus, ClockReference reference, Duration max_clock_difference,
                               Callbacks callbacks)
    : bus_(bus), reference_(reference), callbacks_(std::move(callbacks)), recovery_(max_clock_difference) {
  bus_.at(bus_.now() + kPeriod, [this] { check(); });
}

void HostClockWatch::check() {
  const Duration ahead = callbacks_.host_ahead(), change = ahead - host_ahead_;
  if (change >= ClockRecovery::kMinStep || change <= -ClockRecovery::kMinStep) {
    host_ahead_ = ahead;
    callbacks_.on_step(ahead);
    if (!std::exchange(is_watching_, true)) watch_references();
  }
  if (is_watching_ && recovery_.end_period(ahead, callbacks_.is_in_use())) return callbacks_.on_adopt();
  bus_.at(bus_.now() + kPeriod, [this] { check(); });
}

void HostClockWatch::watch_references() {
  const std::string_view topic =
      reference_ == ClockReference::kRobots ? topics::kFeedback.name : topics::kCoordinator.name;
  bus_.watch_headers([this, topic](const TopicInfo& info, const msg::Header& header) {
    if (info.name == topic) recovery_.on_message(header.sender(), header.stamp_ns(), bus_.now());
  });
  // Without this subscription, some processes would not receive heartbeats.
  if (reference_ == ClockReference::kCoordinators)
    bus_.subscribe(topics::kCoordinator, [](const msg::CoordinatorState&) {});
}

}  // namespace sidestep
