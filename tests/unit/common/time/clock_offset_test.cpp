// SPDX-License-Identifier: Apache-2.0
#include "common/time/clock_offset.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::clock_offset_test {

const Time kBegin = time_from_ns(1'800'000'000'000'000'000);  // a typical host clock
constexpr Duration kPeriod{16'666'667};

/// The ground truth for the estimates: two clocks, and messages between them with random delays.
struct TwoClocks {
  Rng rng;
  Duration offset;  // offset of the peer's clock at kBegin
  double drift_ppm = 0;
  double min_s, mean_s;  ///< delay: a minimum plus an exponentially distributed part
  double loss = 0;

  Duration true_offset(Time local) const {
    return offset + from_seconds(to_seconds(local - kBegin) * drift_ppm * 1e-6);
  }
  Time peer(Time local) const { return local + true_offset(local); }
  Duration delay() { return from_seconds(min_s - mean_s * std::log(1 - rng.uniform())); }
  /// nullopt if a message was lost.
  std::optional<ClockExchange> exchange(Time sent) {
    const Time peer_received = sent + delay();
    const Time peer_sent = peer_received + from_seconds(rng.uniform(0, 0.03));
    const Time received = peer_sent + delay();
    if (rng.chance(loss) || rng.chance(loss)) return std::nullopt;
    return ClockExchange{sent, peer(peer_received), peer(peer_sent), received};
  }
};

ClockExchange exchange_ms(double sent, double peer_received, double peer_sent, double received) {
  const auto at = [](double ms) { return kBegin + from_seconds(ms * 1e-3); };
  return {at(sent), at(peer_received), at(peer_sent), at(received)};
}

TEST_CASE("the measured interval contains the true offset for any delays, losses and drift") {
  const std::uint64_t seed = GENERATE(range(1u, 41u));
  CAPTURE(seed);
  Rng rng(seed);
  const double fraction = rng.uniform(-1, 1);
  TwoClocks clocks{Rng(seed + 100),
                   from_seconds(fraction * std::pow(10, rng.uniform(-5, 4))),
                   rng.uniform(-0.99, 0.99) * ClockOffset::kDrift_ppm,
                   rng.uniform(0, 0.002),
                   std::pow(10, rng.uniform(-5, -1)),
                   seed % 2 ? 0.3 : 0};
  ClockOffset measured;
  int checked = 0;
  Time arrived = kBegin;
  for (int i = 0; i < 3000; ++i) {
    const Time sent = kBegin + i * kPeriod;
    if (const auto exchange = clocks.exchange(sent)) {
      REQUIRE(measured.add(*exchange));
      arrived = std::max(arrived, exchange->received);
    }
    const Time now = std::max(arrived, sent + kPeriod);
    const auto known = measured.at(now);
    if (!known) continue;
    ++checked;
    const Duration truth = clocks.true_offset(now);
    CAPTURE(i, truth.count(), known->low.count(), known->high.count());
    REQUIRE(known->low <= truth);
    REQUIRE(known->high >= truth);
    REQUIRE_FALSE(known->is_beyond(truth < Duration{0} ? -truth : truth));
  }
  CHECK(checked > 2900);
  CHECK(measured.jumps() == 0);
}

TEST_CASE("the uncertainty falls to that of the fastest exchange even if 30 % of the messages are lost") {
  TwoClocks clocks{Rng(7), from_seconds(0.004), 20, 0.0002, 0.001, 0.3};
  ClockOffset measured;
  for (int i = 0; i < 600; ++i) {
    if (const auto exchange = clocks.exchange(kBegin + i * kPeriod)) measured.add(*exchange);
  }
  const Time now = kBegin + 602 * kPeriod;
  REQUIRE(measured.at(now));
  CHECK(measured.at(now)->uncertainty() < from_seconds(0.0006));
  CHECK(measured.at(now)->is_beyond(from_seconds(0.003)));
  CHECK_FALSE(measured.at(now)->is_beyond(from_seconds(0.005)));
}

TEST_CASE("one exchange bounds the offset by its delays, and several exchanges by their intersection") {
  ClockOffset measured;
  CHECK_FALSE(measured.at(kBegin));
  // The peer's clock is 10 ms ahead: 3 ms there, 1 ms until the reply, 2 ms back.
  REQUIRE(measured.add(exchange_ms(0, 13, 14, 6)));
  const auto first = measured.at(kBegin + from_seconds(0.006));
  REQUIRE(first);
  CHECK(to_seconds(first->low) == Approx(0.008).margin(3e-6));
  CHECK(to_seconds(first->high) == Approx(0.013).margin(3e-6));
  REQUIRE(measured.add(exchange_ms(10, 21, 22, 19)));
  const auto both = measured.at(kBegin + from_seconds(0.019));
  CHECK(to_seconds(both->low) == Approx(0.008).margin(8e-6));
  CHECK(to_seconds(both->high) == Approx(0.011).margin(8e-6));
  CHECK(to_seconds(both->middle()) == Approx(0.0095).margin(8e-6));
  CHECK(to_seconds(both->nearest_to_zero()) == Approx(0.008).margin(8e-6));
  const auto later = measured.at(kBegin + from_seconds(1.019));
  CHECK(later->low < both->low);
  CHECK(to_seconds(later->high - both->high) == Approx(ClockOffset::kDrift_ppm * 1e-6).epsilon(1e-3));
  CHECK(measured.at(kBegin + from_seconds(1.019), from_seconds(1.1)));
  CHECK_FALSE(measured.at(kBegin + from_seconds(1.019), from_seconds(0.9)));
}

TEST_CASE("after a clock jump only later exchanges count") {
  const double jump_s = GENERATE(0.05, -0.05, 7.0, -7.0);
  CAPTURE(jump_s);
  TwoClocks clocks{Rng(3), from_seconds(0.001), 0, 0.0005, 0.002};
  ClockOffset measured;
  for (int i = 0; i < 100; ++i) measured.add(*clocks.exchange(kBegin + i * kPeriod));
  const ClockExchange late = *clocks.exchange(kBegin + 99 * kPeriod);
  clocks.offset += from_seconds(jump_s);
  measured.add(*clocks.exchange(kBegin + 102 * kPeriod));
  CHECK(measured.jumps() == 1);
  // A late message from before the jump.
  measured.add(late);
  CHECK(measured.jumps() == 1);
  for (int i = 103; i < 200; ++i) {
    measured.add(*clocks.exchange(kBegin + i * kPeriod));
    const Time now = kBegin + (i + 3) * kPeriod;
    REQUIRE(measured.at(now)->low <= clocks.true_offset(now));
    REQUIRE(measured.at(now)->high >= clocks.true_offset(now));
  }
  CHECK(measured.jumps() == 1);
}

TEST_CASE(
    "if the peer's clock jumps between its two timestamps, the offset is unknown until the next exchange") {
  ClockOffset measured;
  REQUIRE(measured.add(exchange_ms(0, 1, 2, 3)));
  REQUIRE(measured.add(exchange_ms(10, 11, 62, 13)));
  CHECK_FALSE(measured.at(kBegin + from_seconds(0.013)));
  CHECK(measured.jumps() == 1);
  REQUIRE(measured.add(exchange_ms(20, 71, 72, 23)));
  REQUIRE(measured.at(kBegin + from_seconds(0.023)));
  CHECK(measured.at(kBegin + from_seconds(0.023))->is_beyond(from_seconds(0.04)));
  measured.reset();
  CHECK_FALSE(measured.at(kBegin + from_seconds(0.023)));
}

TEST_CASE("invalid timestamps change nothing") {
  ClockOffset measured;
  REQUIRE(measured.add(exchange_ms(0, 1, 2, 3)));
  const auto before = measured.at(kBegin + from_seconds(0.003));
  CHECK_FALSE(measured.add(exchange_ms(10, 11, 12, 9)));     // the answer arrives before the request leaves
  CHECK_FALSE(measured.add(exchange_ms(10, 12, 11, 13)));    // the peer answers before the request arrives
  CHECK_FALSE(measured.add(exchange_ms(-11'000, 1, 2, 3)));  // the exchange takes too long
  constexpr std::int64_t kValid = 1'000'000'000'000'000;
  const std::vector<std::int64_t> hostile{0, -1, std::numeric_limits<std::int64_t>::min(),
                                          std::numeric_limits<std::int64_t>::max(), to_ns(kMaxTime) + 1};
  for (const std::int64_t stamp : hostile) {
    for (int position = 0; position < 4; ++position) {
      std::int64_t stamps[4] = {kValid, kValid + 1, kValid + 2, kValid + 3};
      stamps[position] = stamp;
      CAPTURE(stamp, position);
      CHECK_FALSE(measured.add({time_from_ns(stamps[0]), time_from_ns(stamps[1]), time_from_ns(stamps[2]),
                                time_from_ns(stamps[3])}));
    }
  }
  const auto after = measured.at(kBegin + from_seconds(0.003));
  CHECK(after->low == before->low);
  CHECK(after->high == before->high);
  CHECK(measured.jumps() == 0);
}

TEST_CASE("the most extreme accepted timestamps cause no overflow") {
  ClockOffset measured;
  const Time last = kMaxTime, first = time_from_ns(1);
  REQUIRE(measured.add({first, last, last, first + Duration{5}}));
  REQUIRE(measured.add({last - Duration{5}, first, first, last}));
  CHECK(measured.jumps() == 1);
  REQUIRE(measured.at(last));
  CHECK(measured.at(last)->high < Duration{0});
  CHECK(difference(*measured.at(last), *measured.at(last)).low <= Duration{0});
}

TEST_CASE("the offset of two clocks is the difference of their offsets from a third") {
  const OffsetInterval robot{Duration{100}, Duration{300}}, coordinator{Duration{50}, Duration{80}};
  CHECK(difference(robot, coordinator).low == Duration{20});
  CHECK(difference(robot, coordinator).high == Duration{250});
  CHECK(difference(robot, coordinator).uncertainty() == Duration{115});
  CHECK(difference(robot, coordinator).is_beyond(Duration{19}));
  CHECK_FALSE(difference(robot, coordinator).is_beyond(Duration{20}));
  CHECK(difference(coordinator, robot).is_beyond(Duration{19}));
}

}  // namespace sidestep::clock_offset_test
