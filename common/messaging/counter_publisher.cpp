// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/counter_publisher.hpp"

#include "common/messaging/drop_codec.hpp"

namespace sidestep {

CounterPublisher::CounterPublisher(Bus& bus, std::uint32_t process, Incarnation incarnation,
                                   std::function<void(DropCounters&)> count_drops)
    : bus_(bus), count_drops_(std::move(count_drops)), writer_(bus.advertise(topics::kCounters)) {
  message_.process(process);
  message_.header().sender(process);
  message_.header().incarnation(incarnation);
  message_.counts().reserve(msg::MAX_COUNTERS);
  bus_.at(bus_.now() + kPeriod, [this] { publish(); });
}

void CounterPublisher::publish() {
  bus_.at(bus_.now() + kPeriod, [this] { publish(); });
  DropCounters drops;
  bus_.count_drops(drops);
  count_drops_(drops);
  encode(drops, message_);
  writer_.publish(message_, bus_.now());
}

}  // namespace sidestep
