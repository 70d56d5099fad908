// SPDX-License-Identifier: Apache-2.0
// Fuzzes the filter of datagrams before Fast DDS: forwarded submessages,
// announcements, notices of presence, certificates.
#include <algorithm>
#include <array>
#include <optional>
#include <set>

#include "common/messaging/dds/admission.hpp"
#include "common/messaging/dds/datagram.hpp"
#include "common/messaging/dds/datagram_check.hpp"
#include "common/messaging/dds/datagram_format.hpp"
#include "deploy/run/keys/authority.hpp"
#include "tests/fuzz/fuzz_target.hpp"
#include "tests/fuzz/rtps_bytes.hpp"

namespace sidestep::fuzz {
namespace {

constexpr const char* kVersion = "2.9.1";
constexpr std::int64_t kNow_ns = 1'800'000'000'000'000'000;

/// An authority and the certificate of one agent, new in each process.
struct Keys {
  Time now = time_from_ns(kNow_ns);
  Authority authority{"identity authority", now, now + std::chrono::hours(24)};
  PrivateKey agent_key = make_private_key();
  Certificate agent =
      authority.issue(parse_identity("agent 3").value(), agent_key, now, now + std::chrono::hours(1));
  Admission admission{parse_identity("coordinator 0").value(), authority.certificate(), kVersion};
};

const Keys& keys() {
  static const Keys keys;
  return keys;
}

ParticipantId agent_id() {
  ParticipantId id{};
  std::ranges::copy(keys().agent.prefix(), id.begin());
  id.back() = 1;
  return id;
}

struct Submessage {
  std::uint8_t kind;
  View body;
};

/// The submessages of a datagram, parsed independently of the code under test (RTPS 2.2, 8.3.4 and
/// 9.4.5.1.3). nullopt: a submessage is cut off.
std::optional<std::vector<Submessage>> submessages_of(View datagram) {
  std::vector<Submessage> result;
  for (std::size_t at = kDatagramHeaderSize; at < datagram.size();) {
    if (datagram.size() - at < kSubmessageHeaderSize) return std::nullopt;
    const bool is_little_endian = (datagram[at + 1] & 1) != 0;
    const std::size_t low = datagram[at + (is_little_endian ? 2 : 3)],
                      high = datagram[at + (is_little_endian ? 3 : 2)], size = high * 256 + low;
    if (size > datagram.size() - at - kSubmessageHeaderSize) return std::nullopt;
    result.push_back({datagram[at], datagram.subspan(at + kSubmessageHeaderSize, size)});
    at += kSubmessageHeaderSize + size;
  }
  return result;
}

bool begins(View part, View whole) { return part.data() == whole.data() && part.size() <= whole.size(); }

/// Checks that the filter, which runs with keys, has passed on only known submessages.
void check_passed(View passed) {
  static const std::set<std::uint8_t> kUnderstood{kAckNackSubmessage,     kHeartbeatSubmessage,
                                                  kGapSubmessage,         kTimestampSubmessage,
                                                  kDestinationSubmessage, kDataSubmessage};
  const auto submessages = submessages_of(passed);
  SIDESTEP_REQUIRE(submessages && !submessages->empty());
  for (std::size_t i = 0; i < submessages->size(); ++i) {
    const Submessage& submessage = (*submessages)[i];
    SIDESTEP_REQUIRE(!submessage.body.empty() && submessage.body.size() % 4 == 0);
    if (submessage.kind != kEncryptedPrefixSubmessage) {
      SIDESTEP_REQUIRE(kUnderstood.contains(submessage.kind));
      continue;
    }
    SIDESTEP_REQUIRE(i + 2 < submessages->size());
    const View content = (*submessages)[++i].body, code = (*submessages)[i + 1].body;
    SIDESTEP_REQUIRE((*submessages)[i].kind == kEncryptedBodySubmessage);
    SIDESTEP_REQUIRE((*submessages)[++i].kind == kEncryptedPostfixSubmessage);
    const std::size_t stated =
        std::size_t{content[0]} << 24 | content[1] << 16 | content[2] << 8 | content[3];
    SIDESTEP_REQUIRE(stated > 0 && stated <= content.size() - 4);
    SIDESTEP_REQUIRE(code.size() == 20);
  }
  // Filtering the result again removes nothing.
  SIDESTEP_REQUIRE(checked_datagram(passed).size() == passed.size());
  SIDESTEP_REQUIRE(without_statistics(passed).size() == passed.size());
}

void try_without_timestamp(View passed) {
  Datagram copy;
  if (!copy_without_timestamp(passed, copy)) return;
  SIDESTEP_REQUIRE(copy.size() < passed.size());
  SIDESTEP_REQUIRE(sender_of(copy) == sender_of(passed));
  check_passed(copy);
}

void try_announcement(const ParticipantId& sender, View datagram) {
  bool is_plain = false;
  const auto announcement = participant_announcement(datagram, is_plain);
  SIDESTEP_REQUIRE(is_plain || !announcement);
  if (!announcement || announcement->is_departure) return;
  const View data = announcement->user_data;
  SIDESTEP_REQUIRE(data.empty() || (data.data() >= datagram.data() &&
                                    data.data() + data.size() <= datagram.data() + datagram.size()));
  Admission admission = keys().admission;
  const bool is_admitted =
      admission.on_announcement(sender, data, keys().now).refusal == Admission::Refusal::kNone;
  SIDESTEP_REQUIRE(admission.admits(sender, keys().now) == is_admitted);
  if (!is_admitted) return;
  const Identity* const identity = admission.identity_of(sender);
  SIDESTEP_REQUIRE(identity != nullptr && *identity == parse_identity("agent 3"));
  // The certificate is valid for no other participant id.
  SIDESTEP_REQUIRE(sender == agent_id());
}

/// Returns whether the bytes are valid notices of presence.
bool try_presence(const ParticipantId& sender, View datagram) {
  const auto notices = presence_notices(datagram);
  if (!notices) return false;
  SIDESTEP_REQUIRE(notices->size() <= Presence::kMaxNotices);
  // Compares everything except the versions of protocol and vendor.
  const Datagram again = presence_datagram(sender, *notices);
  SIDESTEP_REQUIRE(std::ranges::equal(View(again).subspan(8), datagram.subspan(8)));
  return true;
}

}  // namespace

bool try_input(View input) {
  const std::optional<ParticipantId> sender = sender_of(input);
  if (!sender) return false;
  if (try_presence(*sender, input)) return true;
  try_announcement(*sender, input);
  const View open = without_statistics(input);
  SIDESTEP_REQUIRE(open.empty() || begins(open, input));
  if (const auto submessages = submessages_of(open))
    // A submessage of size 0 is the last one: the rest of the datagram is its content.
    for (const Submessage& submessage : *submessages) {
      if (submessage.body.empty() && submessage.kind != kTimestampSubmessage &&
          submessage.kind != kPadSubmessage)
        break;
      if (submessage.body.size() % 4 != 0) break;  // Fast DDS continues at a multiple of four
      SIDESTEP_REQUIRE(submessage.kind != kStatisticsSubmessage);
    }
  const View passed = checked_datagram(input);
  if (passed.empty()) return false;
  SIDESTEP_REQUIRE(begins(passed, input));
  check_passed(passed);
  try_without_timestamp(passed);
  return true;
}

std::vector<Bytes> seeds() {
  using namespace rtps;
  const ParticipantId agent = agent_id();
  const Bytes certified = credentials(keys().agent, keys().agent_key, kVersion, agent, keys().now),
              encrypted_timestamp = encrypted(12, 12), encrypted_data = encrypted(70, 72);
  std::vector<Bytes> result{
      datagram(agent, {announcement(agent, certified)}),
      datagram(agent, {timestamp(), announcement(agent, certified)}),
      datagram(agent, {destination(), data(), heartbeat()}),
      datagram(agent, {timestamp(), handshake()}),
      datagram(agent, {destination(), acknowledgement(33, 2)}),
      datagram(agent, {gap(), heartbeat()}),
      datagram(agent, {destination(), encrypted_timestamp, encrypted_data}),
      datagram(agent, {encrypted_timestamp, encrypted_data, statistics()}),
      datagram(agent, {timestamp(), data(), statistics()}),
  };
  using Kind = PresenceNotice::Kind;
  const std::array notices{PresenceNotice{agent, Kind::kForgotten, 7},
                           PresenceNotice{agent, Kind::kAgreed, 1}};
  result.push_back(presence_datagram(agent, {}));
  result.push_back(presence_datagram(agent, notices));
  return result;
}

}  // namespace sidestep::fuzz
