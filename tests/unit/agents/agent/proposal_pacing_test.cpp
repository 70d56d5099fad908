// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/proposal_pacing.hpp"

#include <catch2/catch.hpp>

using namespace sidestep;

namespace {
constexpr Duration kCycle{16'666'667};
}  // namespace

TEST_CASE("on a fast network one cycle ahead is enough, and a single slow answer changes nothing") {
  ProposalPacing pacing(kCycle);
  CHECK(pacing.lead() == 1);
  for (int i = 0; i < 100; ++i) pacing.on_round_trip(i % 20 == 0 ? Duration{40'000'000} : Duration{500'000});
  CHECK(pacing.lead() == 1);
}

TEST_CASE("on a slow network an agent looks as far ahead as answers and commands take") {
  ProposalPacing pacing(kCycle);
  for (int i = 0; i < 20; ++i) pacing.on_round_trip(Duration{100'000'000});
  CHECK(pacing.lead() == 9);  // 150 ms
  CHECK(pacing.patience() == Duration{100'000'000});
  for (int i = 0; i < 20; ++i) pacing.on_round_trip(Duration{500'000});
  CHECK(pacing.lead() == 1);
  for (int i = 0; i < 20; ++i) pacing.on_round_trip(Duration{30'000'000'000});
  CHECK(pacing.lead() == 30);
  pacing.reset();
  CHECK(pacing.lead() == 1);
}

TEST_CASE("what keeps getting lost earns time to ask again, one loss does not") {
  ProposalPacing pacing(kCycle);
  pacing.on_late();
  pacing.on_taken();
  pacing.on_late();
  CHECK(pacing.lead() == 1);
  pacing.on_late();
  CHECK(pacing.lead() == 2);
  for (int i = 0; i < 100; ++i) pacing.on_late();
  const int most = pacing.lead();
  CHECK(most < 10);
  for (int i = 0; i < 100; ++i) pacing.on_taken();
  CHECK(pacing.lead() == 1);
}
