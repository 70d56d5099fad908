// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/clock_codec.hpp"

#include <cmath>
#include <functional>
#include <limits>

#include "common/protocol/senders.hpp"
#include "tests/catch.hpp"

namespace sidestep::clock_codec_test {

constexpr std::int64_t kNow_ns = 1'700'000'000'000'000'000;

msg::ClockReading reading_of(const std::string& host = "robot-7", const std::string& scenario = "") {
  msg::ClockReading message;
  message.process(7);
  message.header().sender(7);
  message.header().incarnation(42);
  message.header().stamp_ns(kNow_ns + 5);
  message.client(1'000'001);
  message.probe_sent_ns(kNow_ns - 100);
  message.probe_received_ns(kNow_ns);
  message.host_ahead_ns(-3);
  message.clock_bound_s(0.0005);
  message.place().assign(host.begin(), host.end());
  message.place().push_back('\n');
  message.place().insert(message.place().end(), scenario.begin(), scenario.end());
  return message;
}

TEST_CASE("a clock reading is decoded unchanged for any time that the clock shows") {
  const auto answer = decode(reading_of());
  REQUIRE(answer);
  CHECK(answer->process == 7);
  CHECK(answer->incarnation == 42);
  CHECK(answer->client == 1'000'001);
  CHECK(to_ns(answer->probe_sent) == kNow_ns - 100);
  CHECK(to_ns(answer->probe_received) == kNow_ns);
  CHECK(to_ns(answer->answered) == kNow_ns + 5);
  CHECK(answer->host_ahead == Duration{-3});
  CHECK(answer->clock_bound_s == 0.0005);
  CHECK(answer->host == "robot-7");
  msg::ClockReading of_referee = reading_of();
  of_referee.process(static_cast<std::uint32_t>(Sender::kReferee));
  of_referee.header().sender(of_referee.process());
  CHECK(decode(of_referee));
  msg::ClockReading from_1970 = reading_of();
  from_1970.probe_received_ns(1'000'000'000);
  from_1970.header().stamp_ns(1'000'000'001);
  CHECK(decode(from_1970));
}

TEST_CASE("a clock reading with any invalid value is refused") {
  const std::vector<std::function<void(msg::ClockReading&)>> changes{
      [](auto& m) { m.process(kMaxRobots), m.header().sender(kMaxRobots); },
      [](auto& m) {
        m.process(static_cast<std::uint32_t>(Sender::kOperator)), m.header().sender(m.process());
      },
      [](auto& m) { m.header().sender(8); },
      [](auto& m) { m.header().stamp_ns(-1); },
      [](auto& m) { m.header().stamp_ns(kNow_ns - 1); },
      [](auto& m) { m.header().stamp_ns(std::numeric_limits<std::int64_t>::max()); },
      [](auto& m) { m.probe_sent_ns(-1); },
      [](auto& m) { m.probe_sent_ns(to_ns(kMaxTime) + 1); },
      [](auto& m) { m.probe_received_ns(std::numeric_limits<std::int64_t>::min()); },
      [](auto& m) { m.host_ahead_ns(std::numeric_limits<std::int64_t>::min()); },
      [](auto& m) { m.host_ahead_ns(std::numeric_limits<std::int64_t>::max()); },
      [](auto& m) { m.clock_bound_s(NAN); },
      [](auto& m) { m.clock_bound_s(-1e-9); },
      [](auto& m) { m.clock_bound_s(1.1); },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    CAPTURE(i);
    msg::ClockReading message = reading_of();
    REQUIRE(decode(message));
    changes[i](message);
    CHECK_FALSE(decode(message));
  }
}

TEST_CASE("host and scenario names cannot contain escape sequences") {
  CHECK(decode(reading_of("a\x1b[2Jb\r\x80 c"))->host == "a?[2Jb???c");
  CHECK(decode(reading_of(""))->host.empty());
  CHECK(decode(reading_of("",
                          "a\x1b\x01"
                          "b"))
            ->scenario == "a??b");
  CHECK(decode(reading_of(""))->scenario.empty());
  msg::ClockReading reading = reading_of();
  reading.place({'a', 'b'});
  CHECK(decode(reading)->host == "ab");
  CHECK(decode(reading)->scenario.empty());
  const std::string longest(300, 'x');
  CHECK(encode_place(longest, longest).size() == msg::MAX_PLACE);
  CHECK(printable_name(std::string(300, 'x')).size() == msg::MAX_PLACE_NAME);
  // Letters of other languages are kept, and no letter is cut in two.
  CHECK(printable_name("über-halle-東") == "über-halle-東");
  CHECK(printable_name("\xc2\x9b"
                       "2J\x7f\xff") == "??2J??");
  CHECK(printable_name(std::string(msg::MAX_PLACE_NAME - 1, 'x') + "ü") ==
        std::string(msg::MAX_PLACE_NAME - 1, 'x'));
}

}  // namespace sidestep::clock_codec_test
