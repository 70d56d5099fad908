// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/blockage_text.hpp"

#include "tests/catch.hpp"

namespace sidestep::blockage_text_test {

TEST_CASE("the text about a blockage states its cause") {
  const auto text = [](msg::BlockReason reason) {
    return to_text(Blockage{reason, 5, {1.234, -2}, {0.5, 0.25}});
  };
  const std::string instead = "; it goes to 0.50,0.25 instead";
  CHECK(text(msg::BlockReason::BLOCK_OBSTACLE) == "an obstacle at 1.23,-2.00 covers its goal" + instead);
  CHECK(text(msg::BlockReason::BLOCK_ROBOT) == "robot 5 stands on its goal" + instead);
  CHECK(text(msg::BlockReason::BLOCK_PASSING_ROBOT) == "robot 5 has to pass first" + instead);
  CHECK(text(msg::BlockReason::BLOCK_ZONE) == "zone 5 covers its goal" + instead);
  CHECK(text(msg::BlockReason::BLOCK_NO_PATH) == "no path leads to its goal" + instead);
  CHECK(text(msg::BlockReason::BLOCK_OCCLUDED_CORNER) ==
        "a person may step out from behind the corner at 1.23,-2.00" + instead);
  CHECK(to_text(Blockage{msg::BlockReason::BLOCK_STRANGER, 0, {1, 2}, {1, 2.25}, 1.5}) ==
        "a stranger 0.25 m away, who may move at 1.5 m/s");
}

}  // namespace sidestep::blockage_text_test
