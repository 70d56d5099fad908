// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/datagram.hpp"

#include <algorithm>
#include <memory>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::datagram_test {

constexpr ParticipantId kSender{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}, kOther{21, 22, 23};

std::vector<PresenceNotice> some_notices() {
  return {{kOther, PresenceNotice::Kind::kForgotten, 0x0123456789abcdefu},
          {kSender, PresenceNotice::Kind::kAgreed, 1}};
}

TEST_CASE("a presence announcement keeps its notices and identifies its sender") {
  for (const auto& notices :
       {std::vector<PresenceNotice>(), some_notices(), std::vector<PresenceNotice>(Presence::kMaxNotices)}) {
    const Datagram datagram = presence_datagram(kSender, notices);
    CHECK(sender_of(datagram) == kSender);
    CHECK(presence_notices(datagram) == notices);
  }
  CHECK(sender_of(departure_of(kOther)) == kOther);
}

TEST_CASE("a presence announcement of the wrong length, kind or size is refused") {
  const Datagram valid = presence_datagram(kSender, some_notices());
  for (std::size_t size = 0; size < valid.size(); ++size) {
    CAPTURE(size);
    CHECK_FALSE(presence_notices(std::span(valid).first(size)));
  }
  Datagram longer = valid;
  longer.push_back(0);
  CHECK_FALSE(presence_notices(longer));
  for (const std::size_t at :
       {20u, 21u, 22u, 24u, 40u}) {  // kind, flags, length, mark and first kind of notice
    CAPTURE(at);
    Datagram changed = valid;
    changed[at] ^= 0x40;
    CHECK_FALSE(presence_notices(changed));
  }
  CHECK_FALSE(
      presence_notices(presence_datagram(kSender, std::vector<PresenceNotice>(Presence::kMaxNotices + 1))));
  CHECK_FALSE(presence_notices(departure_of(kSender)));
}

TEST_CASE("random bytes are not a presence announcement") {
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

TEST_CASE("a process can announce only its own departure") {
  bool is_plain = false;
  const auto own = participant_announcement(departure_of(kSender), is_plain);
  CHECK(is_plain);
  REQUIRE(own);
  CHECK(own->is_departure);
  // announces another participant's departure
  Datagram forged = departure_of(kOther);
  std::copy(kSender.begin(), kSender.end(), forged.begin() + 8);
  CHECK_FALSE(participant_announcement(forged, is_plain));
  CHECK_FALSE(is_plain);
}

TEST_CASE("announcements to processes that have proved their keys are recognised as announcements") {
  // The reader and writer ids follow the headers and the first two fields of the only submessage.
  constexpr std::size_t kReader = 20 + 4 + 4, kWriter = kReader + 4;
  Datagram departure = departure_of(kSender);
  bool is_plain = false;
  departure[kReader] = departure[kWriter] = 0xff;
  departure[kReader + 1] = departure[kWriter + 1] = departure[kReader + 2] = departure[kWriter + 2] = 1;
  const auto announcement = participant_announcement(departure, is_plain);
  REQUIRE(announcement);
  CHECK(announcement->is_departure);
  departure[kWriter + 1] = 0;
  CHECK_FALSE(participant_announcement(departure, is_plain));
}

TEST_CASE("an announcement that changes its source or is truncated is refused") {
  const Datagram valid = departure_of(kSender);
  bool is_plain = false;
  for (std::size_t size = 0; size < valid.size(); ++size) {
    CAPTURE(size);
    const auto announcement = participant_announcement(std::span(valid).first(size), is_plain);
    CHECK_FALSE((is_plain && announcement));
  }
  Datagram with_source(valid.begin(), valid.begin() + 20);
  const Datagram source{0x0c, 1, 20, 0, 0, 0, 0, 0, 2, 2, 1, 15, 21, 22, 23, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  with_source.insert(with_source.end(), source.begin(), source.end());
  with_source.insert(with_source.end(), valid.begin() + 20, valid.end());
  CHECK_FALSE(participant_announcement(with_source, is_plain));
  CHECK_FALSE(is_plain);
}

TEST_CASE("random and corrupted datagrams are never read beyond their ends") {
  const std::uint64_t seed = 42;
  CAPTURE(seed);
  Rng rng(seed);
  for (int i = 0; i < 100'000; ++i) {
    Datagram bytes = departure_of(kSender);
    if (i % 2 == 0) bytes.resize(20 + rng.below(120));
    for (std::size_t at = 20; at < bytes.size(); ++at)
      if (rng.below(6) == 0) bytes[at] = static_cast<std::uint8_t>(rng.bits());
    // A separate copy, so that a sanitizer detects every read beyond the end.
    const std::unique_ptr<std::uint8_t[]> own(new std::uint8_t[bytes.size()]);
    std::copy(bytes.begin(), bytes.end(), own.get());
    const std::span<const std::uint8_t> datagram(own.get(), bytes.size());
    bool is_plain = false;
    const auto announcement = participant_announcement(datagram, is_plain);
    if (announcement && !announcement->user_data.empty())
      CHECK(&announcement->user_data.back() < own.get() + bytes.size());
    Datagram copy;
    if (copy_without_timestamp(datagram, copy)) CHECK(copy.size() < datagram.size());
  }
}

/// A submessage of this kind with `size` bytes.
void append_submessage(Datagram& datagram, std::uint8_t kind, std::uint8_t size, std::uint8_t content) {
  datagram.insert(datagram.end(), {kind, 1, size, 0});
  datagram.insert(datagram.end(), size, content);
}

TEST_CASE("a time stamp is skipped only if it is encrypted and precedes an encrypted message") {
  constexpr std::uint8_t kDestination = 0x0e, kPrefix = 0x31, kBody = 0x30, kPostfix = 0x32;
  const Datagram departure = departure_of(kSender);
  for (const bool has_destination : {false, true}) {
    for (const std::uint8_t first_size : {16, 20}) {
      CAPTURE(has_destination, int{first_size});
      Datagram before(departure.begin(), departure.begin() + 20), after;
      if (has_destination) append_submessage(before, kDestination, 12, 7);
      append_submessage(after, kPrefix, 20, 1);
      append_submessage(after, kBody, 40, 2);
      append_submessage(after, kPostfix, 20, 3);
      Datagram datagram = before, expected = before;
      append_submessage(datagram, kPrefix, 20, 4);
      append_submessage(datagram, kBody, first_size, 5);
      append_submessage(datagram, kPostfix, 20, 6);
      Datagram alone = datagram;
      datagram.insert(datagram.end(), after.begin(), after.end());
      expected.insert(expected.end(), after.begin(), after.end());
      Datagram copy;
      // A time stamp has 12 bytes, preceded by its size.
      const bool has_timestamp = first_size == 16;
      CHECK(copy_without_timestamp(datagram, copy) == has_timestamp);
      if (has_timestamp) CHECK(copy == expected);
      CHECK_FALSE(copy_without_timestamp(alone, copy));
    }
  }
}

}  // namespace sidestep::datagram_test
