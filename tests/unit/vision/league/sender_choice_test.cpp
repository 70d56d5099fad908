// SPDX-License-Identifier: Apache-2.0
#include "vision/league/sender_choice.hpp"

#include <stdexcept>

#include "tests/catch.hpp"

namespace sidestep::sender_choice_test {

using std::chrono::milliseconds;

constexpr Time kBegin = time_from_ns(1'000'000'000'000);
constexpr league::Endpoint kA{0x0a000001, 5000}, kB{0x0a000002, 5000}, kARestarted{0x0a000001, 5001};

TEST_CASE("the first sender is used until it is silent for half a second") {
  SenderChoice choice;
  CHECK(choice.admit(kA, kBegin));
  CHECK_FALSE(choice.admit(kB, kBegin + milliseconds(500)));
  CHECK(choice.refused() == kB);
  CHECK(choice.admit(kA, kBegin + milliseconds(500)));
  CHECK_FALSE(choice.admit(kB, kBegin + milliseconds(1'000)));
  CHECK(choice.refused_packets() == 2);
  CHECK(choice.admit(kB, kBegin + milliseconds(1'001)));
  CHECK_FALSE(choice.admit(kA, kBegin + milliseconds(1'002)));
  CHECK(choice.used() == kB);
}

TEST_CASE("a sender is replaced by its next process, which has another port") {
  SenderChoice choice;
  CHECK(choice.admit(kA, kBegin));
  CHECK(choice.admit(kARestarted, kBegin + milliseconds(600)));
}

TEST_CASE("only listed senders are used, and all of them") {
  SenderChoice any_port({parse_sender("10.0.0.1")});
  CHECK(any_port.admit(kA, kBegin));
  CHECK(any_port.admit(kARestarted, kBegin));
  CHECK_FALSE(any_port.admit(kB, kBegin + std::chrono::seconds(10)));
  SenderChoice one_port({parse_sender("10.0.0.1:5001")});
  CHECK_FALSE(one_port.admit(kA, kBegin));
  CHECK(one_port.admit(kARestarted, kBegin));
  SenderChoice two({kA, kB});
  CHECK(two.admit(kA, kBegin));
  CHECK(two.admit(kB, kBegin));
}

TEST_CASE("a sender of the list that is not an address is refused") {
  for (const char* const text : {"", "host", "10.0.0.1:", "10.0.0.1:0", "224.5.23.2", "10.0.0.1:70000"}) {
    CAPTURE(text);
    CHECK_THROWS_AS(parse_sender(text), std::invalid_argument);
  }
}

}  // namespace sidestep::sender_choice_test
