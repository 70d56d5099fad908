// SPDX-License-Identifier: Apache-2.0
#include "simulator/bases/answer_batch.hpp"

#include "tests/catch.hpp"

namespace sidestep::answer_batch_test {

TEST_CASE("the answers to eight packets for eleven robots are one answer with 88 entries, in order") {
  AnswerBatch batch(8);
  for (int round = 0; round < 3; ++round) {
    for (std::uint32_t packet = 0; packet < 8; ++packet) {
      league::TeamResponse answer;
      for (std::uint32_t number = 0; number < 11; ++number) answer.feedback.push_back({number, packet == 5});
      if (packet == 2) answer.errors.push_back({"UNKNOWN_ROBOT", "there is no blue robot 12"});
      const auto together = batch.add(answer);
      REQUIRE(together.has_value() == (packet == 7));
      if (!together) continue;
      CHECK(together->errors.size() == 1);
      REQUIRE(together->feedback.size() == 88);
      for (std::size_t i = 0; i < 88; ++i) {
        CHECK(together->feedback[i].number == i % 11);
        CHECK(together->feedback[i].has_ball == (i / 11 == 5));
      }
    }
  }
}

}  // namespace sidestep::answer_batch_test
