// SPDX-License-Identifier: Apache-2.0
#include "common/time/rate_limit.hpp"

#include "tests/catch.hpp"

namespace sidestep::rate_limit_test {

Time after_ms(int ms) { return time_from_ns(1'000'000'000'000) + std::chrono::milliseconds(ms); }

TEST_CASE("a rate limit admits a burst of events immediately and then one event per period") {
  RateLimit limit(3, std::chrono::seconds(1));
  int admitted = 0;
  for (int ms = 0; ms < 5000; ms += 10) admitted += limit.admit(after_ms(ms)) ? 1 : 0;
  CHECK(admitted == 3 + 4);
}

TEST_CASE("after a clock is set back, events are blocked for at most the periods of one burst") {
  const int back_ms = GENERATE(1, 900, 2500, 3'600'000);
  CAPTURE(back_ms);
  RateLimit limit(3, std::chrono::seconds(1));
  while (limit.admit(after_ms(3'700'000))) {
  }
  int waited_ms = 0;
  while (!limit.admit(after_ms(3'700'000 - back_ms + waited_ms)) && waited_ms < 100'000) waited_ms += 10;
  CHECK(waited_ms <= 3000);
}

}  // namespace sidestep::rate_limit_test
