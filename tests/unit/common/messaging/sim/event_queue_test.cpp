// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/sim/event_queue.hpp"

#include <map>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::event_queue_test {

TEST_CASE("events are returned in order of time, and at equal times in order of insertion") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u, 4u, 5u);
  CAPTURE(seed);
  Rng rng(seed);
  EventQueue<int> queue;
  std::multimap<Time, int> expected;  // keeps the order of insertion for equal times
  Time now = time_from_ns(1'000'000'000'000);
  const Duration scales[] = {Duration{0},       Duration{3},          Duration{2'000},
                             Duration{600'000}, Duration{33'000'000}, Duration{60'000'000'000}};
  int next = 0;
  for (int step = 0; step < 100'000; ++step) {
    // The queue alternately grows and shrinks.
    if (!expected.empty() && rng.chance(step / 1000 % 2 == 0 ? 0.4 : 0.6)) {
      REQUIRE(queue.next_time() == expected.begin()->first);
      now = expected.begin()->first;
      REQUIRE(queue.pop() == expected.begin()->second);
      expected.erase(expected.begin());
    } else {
      const Duration scale = scales[rng.below(6)];
      const Time when =
          now + Duration{static_cast<std::int64_t>(rng.uniform() * static_cast<double>(scale.count()))};
      queue.push(when, next);
      expected.emplace(when, next++);
      // next_time() does not change the order.
      if (rng.chance(0.3)) REQUIRE(queue.next_time() == expected.begin()->first);
    }
    REQUIRE(queue.is_empty() == expected.empty());
  }
}

TEST_CASE("an event may be inserted before an event whose time next_time() has returned") {
  EventQueue<int> queue;
  queue.push(time_from_ns(5'000'000'000), 1);
  CHECK(queue.next_time() == time_from_ns(5'000'000'000));
  queue.push(time_from_ns(7), 2);
  queue.push(time_from_ns(4'999'999'999), 3);
  CHECK(queue.pop() == 2);
  CHECK(queue.pop() == 3);
  CHECK(queue.pop() == 1);
  CHECK(queue.is_empty());
}

}  // namespace sidestep::event_queue_test
