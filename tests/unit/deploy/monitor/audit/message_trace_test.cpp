// SPDX-License-Identifier: Apache-2.0
#include "deploy/monitor/audit/message_trace.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "common/random/rng.hpp"

namespace sidestep {
namespace {

using namespace std::chrono_literals;

msg::Header head_of(std::uint64_t number, std::int64_t stamp_ns) {
  msg::Header head;
  head.sender(3);
  head.incarnation(7);
  head.message_number(number);
  head.stamp_ns(stamp_ns);
  return head;
}

}  // namespace

TEST_CASE("what a listener misses is counted by the gaps in the numbers") {
  MessageTrace hearing(5ms);
  const Time now = time_from_ns(1'000'000'000);
  for (const std::uint64_t number : {5u, 6u, 9u, 9u, 8u, 8u, 12u})
    (void)hearing.note(1, head_of(number, 0), now);
  CHECK(hearing.heard() == 7);
  CHECK(hearing.missed() == 3);  // 7, 10, 11
  CHECK(hearing.note(1, head_of(13, 0), now).is_next);
  CHECK_FALSE(hearing.note(1, head_of(15, 0), now).is_next);
  CHECK_FALSE(hearing.note(1, head_of(14, 0), now).is_newest);
  CHECK(hearing.note(2, head_of(1, 0), now).is_newest);
}

TEST_CASE("when a message was sent is bounded although its sender's clock is another one") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  Rng rng(seed);
  const std::int64_t ahead_ns = 123'456'789'000;
  MessageTrace hearing(5ms);
  struct Message {
    std::uint64_t number;
    Time sent, heard;
  };
  std::vector<Message> messages;
  for (std::uint64_t i = 1; i <= 2000; ++i) {
    const Time sent = time_from_ns(static_cast<std::int64_t>(1'000'000'000 + i * 16'000'000));
    messages.push_back({i, sent, sent + from_seconds(0.0002 + 0.1 * rng.uniform() * rng.uniform())});
  }
  std::ranges::sort(messages, {}, &Message::heard);
  std::int64_t widest_ns = 0;
  for (const Message& message : messages) {
    const Heard heard =
        hearing.note(1, head_of(message.number, to_ns(message.sent) + ahead_ns), message.heard);
    CHECK(heard.earliest_ns <= to_ns(message.sent));
    CHECK(heard.latest_ns >= to_ns(message.sent));
    CHECK(heard.latest_ns <= to_ns(message.heard));
    if (heard.earliest_ns != 0) widest_ns = std::max(widest_ns, heard.latest_ns - heard.earliest_ns);
  }
  CHECK(widest_ns == 5'000'000);
}

}  // namespace sidestep
