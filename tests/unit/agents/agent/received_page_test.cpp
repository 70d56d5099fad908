// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/received_page.hpp"

#include <limits>

#include "common/messaging/version_codec.hpp"
#include "tests/catch.hpp"

namespace sidestep::received_page_test {

constexpr Time kNow = time_from_ns(1'800'000'000'000'000'000);

msg::LedgerPage page_with(VersionNumber number) {
  msg::LedgerPage page;
  page.page_index(5);
  page.epoch(7);
  page.header().sender(10000);
  page.header().message_number(9);
  page.min_x_m(-1);
  page.min_y_m(-2);
  page.max_x_m(3);
  page.max_y_m(4);
  page.versions().push_back(encode(Version{1, 1, number, 0, Trajectory::resting(Time{}, {0, 0})}));
  return page;
}

TEST_CASE("a page's header is decoded unchanged") {
  const msg::LedgerPage message = page_with(10);
  const auto page = ReceivedPage::decode(message, kNow);
  REQUIRE(page);
  CHECK(page->index() == 5);
  CHECK(page->epoch() == 7);
  CHECK(page->number() == 9);
  CHECK(page->bounds_m().min_m == Vec2(-1, -2));
  CHECK(page->bounds_m().max_m == Vec2(3, 4));
}

TEST_CASE("a page that is not from a coordinator, or whose index or epoch is out of range, is refused") {
  msg::LedgerPage message = page_with(10);
  for (const std::uint32_t index : {kMaxRobots, std::numeric_limits<std::uint32_t>::max()}) {
    message.page_index(index);
    CHECK_FALSE(ReceivedPage::decode(message, kNow));
  }
  message.page_index(kMaxRobots - 1);
  CHECK(ReceivedPage::decode(message, kNow));
  for (const Epoch epoch : {static_cast<Epoch>(to_ns(kNow + std::chrono::hours(1))), Epoch{1} << 62,
                            std::numeric_limits<Epoch>::max()}) {
    message.epoch(epoch);
    CHECK_FALSE(ReceivedPage::decode(message, kNow));
  }
  message.epoch(static_cast<Epoch>(to_ns(kNow)));
  CHECK(ReceivedPage::decode(message, kNow));
  for (const std::uint32_t sender : {0u, 9999u, 10008u, 20000u}) {
    message.header().sender(sender);
    CHECK_FALSE(ReceivedPage::decode(message, kNow));
  }
}

TEST_CASE("all readers of a message share the page that the first one decodes") {
  const msg::LedgerPage message = page_with(10);
  MessageAttachment attachment;
  std::shared_ptr<DecodedLedgerPage> first, second;
  ReceivedPage::decode(message, kNow, &attachment)->update(first);
  ReceivedPage::decode(message, kNow, &attachment)->update(second);
  CHECK(first == second);
  REQUIRE(first->versions.size() == 1);
  CHECK(first->versions[0].number == 10);
}

TEST_CASE("a decoded page is overwritten only if no other reader uses it") {
  const msg::LedgerPage older = page_with(10), newer = page_with(11);
  std::shared_ptr<DecodedLedgerPage> decoded;
  ReceivedPage::decode(older, kNow)->update(decoded);
  const DecodedLedgerPage* memory = decoded.get();
  ReceivedPage::decode(newer, kNow)->update(decoded);
  CHECK(decoded.get() == memory);
  CHECK(decoded->versions[0].number == 11);
  const std::shared_ptr<DecodedLedgerPage> other_reader = decoded;
  ReceivedPage::decode(older, kNow)->update(decoded);
  CHECK(decoded->versions[0].number == 10);
  CHECK(other_reader->versions[0].number == 11);
}

}  // namespace sidestep::received_page_test
