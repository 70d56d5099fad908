// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/server/outbox.hpp"

#include "tests/catch.hpp"

namespace sidestep::outbox_test {

WebMessage message(const std::string& text) { return {std::make_shared<const std::string>(text), false}; }

std::string all_of(Outbox& outbox) {
  std::string all;
  while (const auto next = outbox.take()) all += *next->payload + " ";
  return all;
}

TEST_CASE("a slow viewer gets all events but only the newest message of each state") {
  Outbox outbox;
  for (int i = 0; i < 100; ++i) {
    outbox.put_state(0, message("frame" + std::to_string(i)));
    outbox.put_state(1, message("panels" + std::to_string(i)));
    if (i % 40 == 0) CHECK(outbox.add_event(message("event" + std::to_string(i))));
  }
  CHECK(all_of(outbox) == "event0 event40 event80 panels99 frame99 ");
}

TEST_CASE("no state starves, because states are sent in turn") {
  Outbox outbox;
  std::string taken;
  for (int i = 0; i < 6; ++i) {
    for (const unsigned slot : {0u, 1u, 2u}) outbox.put_state(slot, message(std::to_string(slot)));
    taken += *outbox.take()->payload;
  }
  CHECK(taken == "120120");
}

TEST_CASE("an outbox with too many events reports an overflow") {
  Outbox outbox;
  const WebMessage large = message(std::string(Outbox::kMaxEventBytes / 4, 'x'));
  for (int i = 0; i < 4; ++i) CHECK(outbox.add_event(large));
  CHECK_FALSE(outbox.add_event(large));
}

}  // namespace sidestep::outbox_test
