// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/datagram.hpp"

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::datagram_test {

constexpr ParticipantId kSender{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}, kOther{21, 22, 23};

std::vector<PresenceNotice> some_notices() {
  return {{kOther, PresenceNotice::Kind::kForgotten, 0x0123456789abcdefu},
          {kSender, PresenceNotice::Kind::kAgreed, 1}};
}

TEST_CASE("notices survive a presence announcement, and its sender is known") {
  for (const auto& notices :
       {std::vector<PresenceNotice>(), some_notices(), std::vector<PresenceNotice>(Presence::kMaxNotices)}) {
    const Datagram datagram = presence_datagram(kSender, notices);
    CHECK(sender_of(datagram) == kSender);
    CHECK(presence_notices(datagram) == notices);
  }
  CHECK(sender_of(departure_of(kOther)) == kOther);
}

TEST_CASE("a presence announcement of another length, kind or size is refused") {
  const Datagram valid = presence_datagram(kSender, some_notices());
  for (std::size_t size = 0; size < valid.size(); ++size) {
    CAPTURE(size);
    CHECK_FALSE(presence_notices(std::span(valid).first(size)));
  }
  Datagram longer = valid;
  longer.push_back(0);
  CHECK_FALSE(presence_notices(longer));
  for (const std::size_t at :
       {20u, 21u, 22u, 24u, 40u}) {  // kind, flags, length, mark, kind of the first notice
    CAPTURE(at);
    Datagram changed = valid;
    changed[at] ^= 0x40;
    CHECK_FALSE(presence_notices(changed));
  }
  CHECK_FALSE(
      presence_notices(presence_datagram(kSender, std::vector<PresenceNotice>(Presence::kMaxNotices + 1))));
  CHECK_FALSE(presence_notices(departure_of(kSender)));
}

TEST_CASE("random bytes are no presence announcement") {
  const std::uint64_t seed = 3;
  CAPTURE(seed);
  Rng rng(seed);
  for (int i = 0; i < 10000; ++i) {
    Datagram bytes(rng.below(300));
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(rng.bits());
    CHECK_FALSE(presence_notices(bytes));
    CHECK_FALSE(sender_of(bytes));
  }
}

}  // namespace sidestep::datagram_test
