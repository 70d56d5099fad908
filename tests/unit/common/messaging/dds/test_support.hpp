// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <unistd.h>
#include <vector>

#include "common/messaging/cdr.hpp"
#include "common/messaging/dds/bus.hpp"
#include "common/messaging/dds/event_loop.hpp"
#include "common/random/rng.hpp"
#include "tests/capture_output.hpp"
#include "tests/test_domain.hpp"

namespace sidestep {

/// Long enough for a machine that is busy with other tests. Only a failing test waits this long.
inline constexpr Duration kDeadline{30'000'000'000};
inline constexpr Duration kStep{2'000'000};

/// Settings for a domain that only this test process uses, on the loopback interface.
inline DdsSettings test_settings(const std::string& participant = "test") {
  static const TestDomain domain;
  return domain.settings(participant);
}

/// Runs the buses in turn until the condition holds. Returns false if the deadline passes first.
template <typename Condition, typename... Buses>
bool run_until(Condition condition, Buses&... buses) {
  const Time deadline = EventLoop::now() + kDeadline;
  while (!condition()) {
    (buses.run_until(buses.now() + kStep), ...);
    if (EventLoop::now() > deadline) return condition();
  }
  return true;
}

/// A payload without encapsulation header from which any message type can be decoded: bytes of 0 and 1, so
/// booleans are valid and numbers finite.
inline std::vector<std::uint8_t> random_body(Rng& rng, std::size_t size) {
  std::vector<std::uint8_t> result(size);
  for (std::uint8_t& byte : result) byte = static_cast<std::uint8_t>(rng.bits() & 1);
  return result;
}

/// A message with random members, and `elements` elements in its final sequence, if it has one.
template <typename Message>
Message random_message(Rng& rng, bool has_sequence, std::uint32_t elements) {
  const std::size_t fixed = fast_dds::cdr_size(Message());
  std::vector<std::uint8_t> body = random_body(rng, fixed + std::size_t{512} * elements);
  if (has_sequence) std::memcpy(body.data() + fixed - sizeof elements, &elements, sizeof elements);
  Message message;
  fast_dds::CdrCoder(body, ByteOrder::kLittleEndian).read(message);
  return message;
}

}  // namespace sidestep
