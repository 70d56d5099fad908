// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/clock_responder.hpp"

#include <utility>

#include "common/messaging/clock_codec.hpp"

namespace sidestep {

ClockResponder::ClockResponder(Bus& bus, const Identity& identity, std::function<Duration()> host_ahead)
    : bus_(bus), host_ahead_(std::move(host_ahead)), writer_(bus.advertise(topics::kClockReading)) {
  reading_.process(identity.process);
  reading_.header().sender(identity.process);
  reading_.header().incarnation(identity.incarnation);
  reading_.clock_bound_s(identity.clock_bound_s);
  reading_.place(encode_place(identity.host, identity.scenario));
  bus_.subscribe(topics::kClockProbe, [this](const msg::ClockProbe& probe) { answer(probe); });
}

void ClockResponder::answer(const msg::ClockProbe& probe) {
  const Time received = bus_.now();
  if (!limit_.admit(received)) return;
  reading_.client(probe.client());
  reading_.probe_sent_ns(probe.header().stamp_ns());
  reading_.probe_received_ns(to_ns(received));
  reading_.host_ahead_ns(host_ahead_().count());
  writer_.publish(reading_, bus_.now());
}

}  // namespace sidestep
