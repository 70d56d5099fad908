// SPDX-License-Identifier: Apache-2.0
#include "agents/tactics/referee_stream.hpp"

#include "tests/catch.hpp"

namespace sidestep::referee_stream_test {

using namespace std::chrono_literals;
using league::RefereeCommand;
using Outcome = RefereeStream::Outcome;

constexpr league::Endpoint kReferee{0x7f000001, 4000}, kOther{0x7f000001, 4001};
const Time kBegin = time_from_ns(1'000'000'000'000);

league::RefereePacket packet(RefereeCommand command, Duration sent) { return {sent, command, 0, {}, {}}; }

TEST_CASE("packets that arrive late are ignored, except for HALT") {
  RefereeStream stream;
  CHECK(stream.add(packet(RefereeCommand::kForceStart, 10s), kReferee, kBegin) == Outcome::kAccepted);
  CHECK(stream.add(packet(RefereeCommand::kHalt, 11s), kReferee, kBegin + 1ms) == Outcome::kAccepted);
  CHECK(stream.add(packet(RefereeCommand::kForceStart, 10s), kReferee, kBegin + 2ms) == Outcome::kLate);
  CHECK(stream.add(packet(RefereeCommand::kHalt, 10s), kReferee, kBegin + 3ms) == Outcome::kAccepted);
  CHECK(stream.add(packet(RefereeCommand::kStop, 10s), kReferee, kBegin + 4ms) == Outcome::kLate);
  CHECK(stream.add(packet(RefereeCommand::kStop, 11s), kReferee, kBegin + 5ms) == Outcome::kAccepted);
}

TEST_CASE("a referee whose clock was set back is accepted again after a silence") {
  RefereeStream stream;
  REQUIRE(stream.add(packet(RefereeCommand::kStop, 1000s), kReferee, kBegin) == Outcome::kAccepted);
  Time now = kBegin;
  for (int i = 1; i <= 5; ++i) {
    now = kBegin + i * 100ms;
    CHECK(stream.add(packet(RefereeCommand::kForceStart, 1s + i * 100ms), kReferee, now) == Outcome::kLate);
  }
  now += 100ms;
  CHECK(stream.add(packet(RefereeCommand::kForceStart, 2s), kReferee, now) == Outcome::kAccepted);
  CHECK(stream.add(packet(RefereeCommand::kStop, 2100ms), kReferee, now + 100ms) == Outcome::kAccepted);
}

TEST_CASE("another sender is accepted only after the referee has been silent") {
  RefereeStream stream;
  REQUIRE(stream.add(packet(RefereeCommand::kStop, 10s), kReferee, kBegin) == Outcome::kAccepted);
  CHECK(stream.add(packet(RefereeCommand::kHalt, 20s), kOther, kBegin + 100ms) == Outcome::kForeign);
  CHECK(stream.add(packet(RefereeCommand::kStop, 11s), kReferee, kBegin + 400ms) == Outcome::kAccepted);
  CHECK(stream.add(packet(RefereeCommand::kHalt, 21s), kOther, kBegin + 800ms) == Outcome::kForeign);
  CHECK(stream.add(packet(RefereeCommand::kHalt, 5s), kOther, kBegin + 1s) == Outcome::kAccepted);
  CHECK(stream.referee() == kOther);
  CHECK(stream.add(packet(RefereeCommand::kStop, 12s), kReferee, kBegin + 1001ms) == Outcome::kForeign);
}

}  // namespace sidestep::referee_stream_test
