// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/proposal_pacing.hpp"

#include "tests/catch.hpp"

namespace sidestep::proposal_pacing_test {

constexpr Duration kCycle{16'666'667};

TEST_CASE("on a fast network the lead is one cycle, and single slow answers do not change it") {
  ProposalPacing pacing(kCycle);
  CHECK(pacing.lead() == 1);
  for (int i = 0; i < 100; ++i) pacing.on_round_trip(i % 20 == 0 ? Duration{40'000'000} : Duration{500'000});
  CHECK(pacing.lead() == 1);
}

TEST_CASE("two slow answers among the last sixteen are tolerated, but more increase the lead") {
  for (int slow = 0; slow <= 16; ++slow) {
    CAPTURE(slow);
    ProposalPacing pacing(kCycle);
    for (int i = 0; i < 16; ++i) pacing.on_round_trip(Duration{i < slow ? 100'000'000 : 500'000});
    CHECK(pacing.lead() == (slow <= 2 ? 1 : 9));
  }
}

TEST_CASE("on a slow network the lead covers the answer and the command") {
  ProposalPacing pacing(kCycle);
  for (int i = 0; i < 20; ++i) pacing.on_round_trip(Duration{100'000'000});
  CHECK(pacing.lead() == 9);  // 150 ms
  CHECK(pacing.answer_timeout() == Duration{100'000'000});
  for (int i = 0; i < 20; ++i) pacing.on_round_trip(Duration{500'000});
  CHECK(pacing.lead() == 1);
  for (int i = 0; i < 20; ++i) pacing.on_round_trip(Duration{30'000'000'000});
  CHECK(pacing.lead() == 30);
  pacing.reset();
  CHECK(pacing.lead() == 1);
}

TEST_CASE("the lead includes the robot's own lead in addition to the coordinator's round trip") {
  ProposalPacing pacing(kCycle);
  pacing.set_robot_lead(Duration{100'000'000});
  CHECK(pacing.lead() == 6);
  pacing.on_round_trip(Duration{20'000'000});
  CHECK(pacing.lead() == 8);  // 130 ms
  CHECK(pacing.answer_timeout() == Duration{20'000'000});
  pacing.reset();
  CHECK(pacing.lead() == 6);
  pacing.set_robot_lead(Duration{0});
  CHECK(pacing.lead() == 1);
}

TEST_CASE("repeated late versions increase the lead, but a single late version does not") {
  ProposalPacing pacing(kCycle);
  pacing.on_version_late();
  pacing.on_version_taken();
  pacing.on_version_late();
  CHECK(pacing.lead() == 1);
  pacing.on_version_late();
  CHECK(pacing.lead() == 2);
  for (int i = 0; i < 100; ++i) pacing.on_version_late();
  const int max_lead = pacing.lead();
  CHECK(max_lead < 10);
  for (int i = 0; i < 100; ++i) pacing.on_version_taken();
  CHECK(pacing.lead() == 1);
}

}  // namespace sidestep::proposal_pacing_test
