// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/comparable_stamps.hpp"

#include "tests/catch.hpp"

namespace sidestep::comparable_stamps_test {

constexpr std::uint32_t kSender = 10'000;

msg::Header header(std::uint64_t number, std::int64_t stamp_ns, Incarnation incarnation = 1,
                   std::uint32_t sender = kSender) {
  msg::Header header;
  header.sender(sender);
  header.incarnation(incarnation);
  header.message_number(number);
  header.stamp_ns(stamp_ns);
  return header;
}

TEST_CASE("if stamps grow with the message numbers of one channel, they show the order of messages") {
  ComparableStamps stamps;
  CHECK_FALSE(stamps.are_in_order(kSender, 1));
  for (const auto& [number, stamp_ns] : {std::pair(3, 300), {1, 100}, {2, 100}, {4, 300}, {4, 300}, {3, 300}})
    stamps.record(0, header(static_cast<std::uint64_t>(number), stamp_ns));
  stamps.record(1, header(1, 200));  // numbers of different channels are not compared
  CHECK(stamps.are_in_order(kSender, 1));
  CHECK_FALSE(stamps.are_in_order(kSender, 2));
  CHECK_FALSE(stamps.are_in_order(kSender + 1, 1));
}

TEST_CASE("stamps of a clock that was set back do not show the order until the process is restarted") {
  const bool arrives_in_order = GENERATE(true, false);
  ComparableStamps stamps;
  stamps.record(0, arrives_in_order ? header(1, 200) : header(2, 100));
  CHECK(stamps.are_in_order(kSender, 1));
  stamps.record(0, arrives_in_order ? header(2, 100) : header(1, 200));
  CHECK_FALSE(stamps.are_in_order(kSender, 1));
  stamps.record(0, header(3, 300));
  CHECK_FALSE(stamps.are_in_order(kSender, 1));
  stamps.record(0, header(1, 50, 2));
  stamps.record(0, header(1, 50, 1, kSender + 1));
  CHECK(stamps.are_in_order(kSender, 2));
  CHECK(stamps.are_in_order(kSender + 1, 1));
}

TEST_CASE("after thousands of process runs, the stamps of the latest runs still give the order") {
  ComparableStamps stamps;
  for (Incarnation run = 1; run <= 10'000; ++run) {
    stamps.record(0, header(1, 100, run));
    CHECK(stamps.are_in_order(kSender, run));
  }
  CHECK_FALSE(stamps.are_in_order(kSender, 1));
}

}  // namespace sidestep::comparable_stamps_test
