// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/sim/event_queue.hpp"

#include <catch2/catch.hpp>
#include <map>

#include "common/random/rng.hpp"

using namespace sidestep;

TEST_CASE("events come by time, and those of one time as they were put in, near or far ahead") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u, 4u, 5u);
  CAPTURE(seed);
  Rng rng(seed);
  EventQueue<int> queue;
  std::multimap<Time, int> expected;  // keeps the order of insertion among equals
  Time now = time_from_ns(1'000'000'000'000);
  const Duration scales[] = {Duration{0},       Duration{3},          Duration{2'000},
                             Duration{600'000}, Duration{33'000'000}, Duration{60'000'000'000}};
  int next = 0;
  for (int step = 0; step < 100'000; ++step) {
    // Sometimes many are waiting, sometimes none.
    if (!expected.empty() && rng.chance(step / 1000 % 2 == 0 ? 0.4 : 0.6)) {
      REQUIRE(queue.next_time() == expected.begin()->first);
      now = expected.begin()->first;
      REQUIRE(queue.take() == expected.begin()->second);
      expected.erase(expected.begin());
    } else {
      const Duration scale = scales[rng.below(6)];
      const Time when =
          now + Duration{static_cast<std::int64_t>(rng.uniform() * static_cast<double>(scale.count()))};
      queue.put(when, next);
      expected.emplace(when, next++);
      // Looking does not change what comes next.
      if (rng.chance(0.3)) REQUIRE(queue.next_time() == expected.begin()->first);
    }
    REQUIRE(queue.is_empty() == expected.empty());
  }
}

TEST_CASE("an event may be put in before another that was already looked at") {
  EventQueue<int> queue;
  queue.put(time_from_ns(5'000'000'000), 1);
  CHECK(queue.next_time() == time_from_ns(5'000'000'000));
  queue.put(time_from_ns(7), 2);
  queue.put(time_from_ns(4'999'999'999), 3);
  CHECK(queue.take() == 2);
  CHECK(queue.take() == 3);
  CHECK(queue.take() == 1);
  CHECK(queue.is_empty());
}
