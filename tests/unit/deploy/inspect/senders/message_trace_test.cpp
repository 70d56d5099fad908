// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/senders/message_trace.hpp"

#include <algorithm>
#include <set>
#include <vector>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::message_trace_test {

using namespace std::chrono_literals;

msg::Header head_of(std::uint64_t number, std::int64_t stamp_ns) {
  msg::Header header;
  header.sender(3);
  header.incarnation(7);
  header.message_number(number);
  header.stamp_ns(stamp_ns);
  return header;
}

TEST_CASE("missed messages are counted by the gaps in message numbers") {
  MessageTrace trace(5ms);
  const Time now = time_from_ns(1'000'000'000);
  for (const std::uint64_t number : {5u, 6u, 9u, 9u, 8u, 8u, 12u})
    (void)trace.record(1, head_of(number, 0), now);
  CHECK(trace.received() == 7);
  CHECK(trace.missed() == 3);  // 7, 10, 11
  CHECK(trace.record(1, head_of(13, 0), now).is_next);
  CHECK_FALSE(trace.record(1, head_of(15, 0), now).is_next);
  CHECK_FALSE(trace.record(1, head_of(14, 0), now).is_newest);
  CHECK(trace.record(2, head_of(1, 0), now).is_newest);
}

TEST_CASE("messages before the first received message count as neither received nor missed") {
  MessageTrace trace(5ms);
  const Time now = time_from_ns(1'000'000'000);
  for (const std::uint64_t number : {10u, 12u, 9u, 8u}) (void)trace.record(1, head_of(number, 0), now);
  CHECK(trace.distinct() == 2);
  CHECK(trace.missed() == 1);
}

TEST_CASE("received and missed messages agree with sets of their numbers") {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    MessageTrace trace(5ms);
    const Time now = time_from_ns(1'000'000'000);
    const double loss = rng.uniform(0, 0.9);
    std::vector<std::pair<double, std::uint64_t>> arrivals;
    for (std::uint64_t number = 1 + rng.below(1000), left = 500; left > 0; ++number, --left) {
      for (int copy = 0; copy < 2; ++copy) {
        // Messages are delayed by up to thirty messages.
        if (copy == 0 ? !rng.chance(loss) : rng.chance(0.1))
          arrivals.emplace_back(static_cast<double>(number) + rng.uniform(0, 30), number);
      }
    }
    std::ranges::sort(arrivals);
    if (arrivals.empty()) continue;
    const std::uint64_t first = arrivals.front().second;
    std::set<std::uint64_t> numbers;
    for (const auto& [arrival, number] : arrivals) {
      (void)trace.record(1, head_of(number, 0), now);
      if (number >= first) numbers.insert(number);
    }
    CHECK(trace.received() == arrivals.size());
    CHECK(trace.distinct() == numbers.size());
    CHECK(trace.missed() == *numbers.rbegin() - first + 1 - numbers.size());
  }
}

TEST_CASE("the sending time is bounded even if the sender's clock has an unknown offset") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  Rng rng(seed);
  const std::int64_t offset_ns = 123'456'789'000;
  MessageTrace trace(5ms);
  struct Message {
    std::uint64_t number;
    Time sent, received;
  };
  std::vector<Message> messages;
  for (std::uint64_t i = 1; i <= 2000; ++i) {
    const Time sent = time_from_ns(static_cast<std::int64_t>(1'000'000'000 + i * 16'000'000));
    const double max_delay_s = 0.1 * rng.uniform();
    messages.push_back({i, sent, sent + from_seconds(0.0002 + max_delay_s * rng.uniform())});
  }
  std::ranges::sort(messages, {}, &Message::received);
  std::int64_t widest_ns = 0;
  for (const Message& message : messages) {
    const Reception reception =
        trace.record(1, head_of(message.number, to_ns(message.sent) + offset_ns), message.received);
    CHECK(reception.earliest_ns <= to_ns(message.sent));
    CHECK(reception.latest_ns >= to_ns(message.sent));
    CHECK(reception.latest_ns <= to_ns(message.received));
    if (reception.earliest_ns != 0)
      widest_ns = std::max(widest_ns, reception.latest_ns - reception.earliest_ns);
  }
  CHECK(widest_ns == 5'000'000);
}

}  // namespace sidestep::message_trace_test
