// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/fault/attestation_exchange.hpp"

#include "tests/catch.hpp"

namespace sidestep::attestation_exchange_test {

using namespace std::chrono_literals;
using State = AttestationExchange::State;

constexpr Time kBegin = time_from_ns(1'000'000'000);

TEST_CASE("an attestation is repeated until the coordinator stops waiting for the robot") {
  AttestationExchange exchange(7, kBegin);
  CHECK(exchange.update(true, kBegin));
  CHECK_FALSE(exchange.update(true, kBegin + 199ms));
  CHECK(exchange.update(true, kBegin + 200ms));
  CHECK(exchange.state() == State::kPending);
  CHECK_FALSE(exchange.update(false, kBegin + 300ms));
  CHECK(exchange.state() == State::kAccepted);
  // In a new epoch the coordinator may wait for the robot again, but then the operator must check again.
  CHECK_FALSE(exchange.update(true, kBegin + 1s));
  CHECK(exchange.state() == State::kAccepted);
}

TEST_CASE("an attestation that is not accepted ends after a timeout with the reason") {
  AttestationExchange exchange(7, kBegin);
  const bool is_missing = GENERATE(true, false);
  CAPTURE(is_missing);
  int sent = 0;
  for (Duration d = 0ms; d <= AttestationExchange::kTimeout; d += 100ms)
    sent += exchange.update(is_missing, kBegin + d);
  CHECK(sent == (is_missing ? 26 : 0));
  CHECK(exchange.state() == State::kPending);
  CHECK_FALSE(exchange.update(is_missing, kBegin + AttestationExchange::kTimeout + 1ms));
  CHECK(exchange.state() == State::kTimedOut);
  CHECK_THAT(exchange.reason(), ContainsSubstring(is_missing ? "still waits" : "does not wait"));
}

}  // namespace sidestep::attestation_exchange_test
