// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/negotiation_codec.hpp"

#include <limits>

#include "common/messaging/version_codec.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/messaging/random_messages.hpp"
#include "tests/unit/common/messaging/same_version.hpp"

namespace sidestep::negotiation_codec_test {

using namespace random_messages;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Version resting(VersionNumber number, RobotId robot = kRobot) {
  return {robot, 1, number, 5, Trajectory::resting(Time{}, {1, 2})};
}

/// A proposal with the maximum number of candidates.
msg::Proposal full_proposal() {
  Proposal proposal{kRobot, 1000, 7, time_from_ns(5), 10, msg::MAX_CANDIDATES};
  for (std::size_t i = 0; i < msg::MAX_CANDIDATES; ++i) proposal.candidates[i] = resting(10 + i);
  return message_of(proposal);
}

/// A registration with the maximum number of versions.
msg::Registration full_registration() {
  Registration registration{kRobot, 1000, 7, time_from_ns(5), VersionSet()};
  for (VersionNumber number = 1; !registration.versions->is_full(); ++number)
    registration.versions->add(resting(number));
  return message_of(registration);
}

TEST_CASE("a proposal survives encoding and decoding bit for bit") {
  const std::uint64_t seed = GENERATE(1u, 2u);
  CAPTURE(seed);
  Rng rng(seed);
  for (int i = 0; i < 2000; ++i) {
    const Proposal in = random_proposal(rng);
    const auto out = decode(message_of(in), kNow);
    REQUIRE(out);
    REQUIRE(out->robot == in.robot);
    REQUIRE(out->incarnation == in.incarnation);
    REQUIRE(out->epoch == in.epoch);
    REQUIRE(out->sent_at == in.sent_at);
    REQUIRE(out->number == in.number);
    REQUIRE(out->candidate_count == in.candidate_count);
    for (std::size_t k = 0; k < in.candidate_count; ++k) {
      REQUIRE(out->candidates[k]);
      REQUIRE(is_same(*out->candidates[k], *in.candidates[k]));
    }
  }
}

TEST_CASE("a registration survives encoding and decoding bit for bit") {
  const std::uint64_t seed = GENERATE(1u, 2u);
  CAPTURE(seed);
  Rng rng(seed);
  for (int i = 0; i < 2000; ++i) {
    const Registration in = random_registration(rng);
    const msg::Registration message = message_of(in);
    REQUIRE(message.is_absent() == in.versions->versions().empty());
    const auto out = decode(message, kNow);
    REQUIRE(out);
    REQUIRE(out->robot == in.robot);
    REQUIRE(out->incarnation == in.incarnation);
    REQUIRE(out->epoch == in.epoch);
    REQUIRE(out->sent_at == in.sent_at);
    REQUIRE(out->versions);
    REQUIRE(std::ranges::equal(out->versions->versions(), in.versions->versions(),
                               [](const Version& a, const Version& b) { return is_same(a, b); }));
  }
}

TEST_CASE("a verdict survives encoding and decoding") {
  const std::uint64_t seed = GENERATE(1u, 2u);
  CAPTURE(seed);
  Rng rng(seed);
  for (int i = 0; i < 2000; ++i) {
    const Verdict in = random_verdict(rng);
    const auto out = decode(message_of(in), kRobot);
    REQUIRE(out);
    REQUIRE(out->sender == in.sender);
    REQUIRE(out->incarnation == in.incarnation);
    REQUIRE(out->robot == in.robot);
    REQUIRE(out->epoch == in.epoch);
    REQUIRE(out->sent_at == in.sent_at);
    REQUIRE(out->proposal_number == in.proposal_number);
    REQUIRE(out->request_sent_at == in.request_sent_at);
    REQUIRE(out->granted_version == in.granted_version);
    REQUIRE(out->reasons == in.reasons);
    REQUIRE(out->blockers == in.blockers);
  }
}

TEST_CASE("a message that does not concern its sender's own robot is refused") {
  const auto check_refused = [](auto message) {
    REQUIRE(decode(message, kNow));
    message.header().sender(kRobot + 1);
    CHECK_FALSE(decode(message, kNow));
    message.robot(kRobot + 1);
    CHECK(decode(message, kNow));
    for (const RobotId robot : {kMaxRobots, std::numeric_limits<RobotId>::max()}) {
      message.robot(robot);
      message.header().sender(robot);
      CHECK_FALSE(decode(message, kNow));
    }
  };
  check_refused(full_proposal());
  check_refused(full_registration());
}

TEST_CASE("an invalid candidate is malformed, and the other candidates remain") {
  const std::size_t hostile = GENERATE(range(0, int{msg::MAX_CANDIDATES}));
  CAPTURE(hostile);
  const auto check_malformed = [=](auto spoil) {
    msg::Proposal message = full_proposal();
    spoil(message.candidates()[hostile]);
    const auto proposal = decode(message, kNow);
    REQUIRE(proposal);
    CHECK(proposal->number == 10);
    REQUIRE(proposal->candidate_count == msg::MAX_CANDIDATES);
    for (std::size_t i = 0; i < msg::MAX_CANDIDATES; ++i)
      CHECK(proposal->candidates[i].has_value() == (i != hostile));
  };
  check_malformed([](msg::Version& v) { v.x_m(kNan); });
  check_malformed([](msg::Version& v) { v.phase_count(99); });
  check_malformed([](msg::Version& v) { v.robot(kRobot + 1); });
  check_malformed([](msg::Version& v) { v.robot(kMaxRobots); });
}

TEST_CASE("candidates whose base or start differs from the first candidate's are malformed") {
  msg::Proposal message = full_proposal();
  message.candidates()[1].base(6);
  message.candidates()[3].start_ns(1);
  const auto proposal = decode(message, kNow);
  REQUIRE(proposal);
  for (std::size_t i = 0; i < msg::MAX_CANDIDATES; ++i)
    CHECK(proposal->candidates[i].has_value() == (i != 1 && i != 3));
  // If the first candidate differs from all later candidates, the later candidates are malformed.
  message = full_proposal();
  message.candidates()[0].base(6);
  CHECK(decode(message, kNow)->candidates[0]);
  CHECK_FALSE(decode(message, kNow)->candidates[1]);
}

TEST_CASE("a proposal with no or too many candidates is decoded without candidates") {
  for (const int count : {0, msg::MAX_CANDIDATES + 1, 255}) {
    CAPTURE(count);
    msg::Proposal message = full_proposal();
    message.candidate_count(static_cast<std::uint8_t>(count));
    const auto proposal = decode(message, kNow);
    REQUIRE(proposal);
    CHECK(proposal->candidate_count == 0);
    CHECK(proposal->number == 10);
    CHECK_FALSE(proposal->candidates[0]);
  }
}

TEST_CASE("a registration with invalid versions is decoded without versions") {
  using Message = msg::Registration;
  const auto is_malformed = [](auto spoil) {
    Message message = full_registration();
    REQUIRE(decode(message, kNow)->versions);
    spoil(message);
    const auto registration = decode(message, kNow);
    REQUIRE(registration);
    return !registration->versions;
  };
  CHECK(is_malformed([](Message& m) { m.version_count(VersionSet::kCapacity + 1); }));
  CHECK(is_malformed([](Message& m) { m.version_count(255); }));
  CHECK(is_malformed([](Message& m) { m.version_count(0); }));  // contradicts is_absent
  CHECK(is_malformed([](Message& m) { m.is_absent(true); }));
  for (std::size_t i = 0; i < VersionSet::kCapacity; ++i) {
    CAPTURE(i);
    CHECK(is_malformed([=](Message& m) { m.versions()[i].vy_mps(kNan); }));
    CHECK(is_malformed([=](Message& m) { m.versions()[i].phase_count(99); }));
    CHECK(is_malformed([=](Message& m) { m.versions()[i].robot(kRobot + 1); }));
    const std::size_t other = (i + 1) % VersionSet::kCapacity;
    CHECK(is_malformed([=](Message& m) { m.versions()[i] = m.versions()[other]; }));
  }
  // Versions beyond version_count are not read.
  CHECK_FALSE(is_malformed([](Message& m) { m.version_count(7), m.versions()[7].x_m(kNan); }));
  CHECK_FALSE(is_malformed([](Message& m) { m.version_count(0), m.is_absent(true); }));
}

TEST_CASE("a verdict for another robot or with an unknown reason is refused") {
  msg::Verdict message;
  message.robot(kRobot);
  message.header().sender(10003);
  REQUIRE(decode(message, kRobot));
  CHECK_FALSE(decode(message, kRobot + 1));
  for (std::size_t i = 0; i < msg::MAX_CANDIDATES; ++i) {
    for (const std::uint32_t reason : {static_cast<std::uint32_t>(msg::Reason::REASON_HELD) + 1,
                                       std::numeric_limits<std::uint32_t>::max()}) {
      CAPTURE(i, reason);
      msg::Verdict hostile = message;
      hostile.reasons()[i] = static_cast<msg::Reason>(reason);
      CHECK_FALSE(decode(hostile, kRobot));
    }
  }
}

TEST_CASE("a message with an implausible incarnation or epoch is refused") {
  const auto check_refused = [](auto message) {
    REQUIRE(decode(message, kNow));
    for (const std::uint64_t number : {static_cast<std::uint64_t>(to_ns(kNow + std::chrono::hours(1))),
                                       std::uint64_t{1} << 62, std::numeric_limits<std::uint64_t>::max()}) {
      auto hostile = message;
      hostile.epoch(number);
      CHECK_FALSE(decode(hostile, kNow));
      hostile = message;
      hostile.header().incarnation(number);
      CHECK_FALSE(decode(hostile, kNow));
    }
  };
  check_refused(full_proposal());
  check_refused(full_registration());
  msg::CoordinatorState state;
  state.header().sender(10000);
  check_refused(state);
}

TEST_CASE("only a coordinator may send a coordinator's messages") {
  msg::CoordinatorState state;
  msg::Verdict verdict;
  verdict.robot(kRobot);
  for (const std::uint32_t sender : {0u, kRobot, 9999u, 10008u, 20000u, 30000u, 4294967295u}) {
    CAPTURE(sender);
    state.header().sender(sender);
    verdict.header().sender(sender);
    CHECK_FALSE(decode(state, kNow));
    CHECK_FALSE(decode(verdict, kRobot));
  }
  state.header().sender(10007);
  verdict.header().sender(10007);
  CHECK_FALSE(decode(state, kNow));  // the message names a coordinator other than its sender
  state.coordinator(7);
  CHECK(decode(state, kNow));
  CHECK(decode(verdict, kRobot));
}

TEST_CASE("a coordinator's heartbeat is decoded unchanged") {
  msg::CoordinatorState message;
  message.coordinator(1);
  message.header().sender(10001);
  message.header().incarnation(8);
  message.epoch(7);
  message.coordinator_mode(msg::CoordinatorMode::COORDINATOR_REGISTERING);
  message.watched_until_ns(to_ns(kNow));
  msg::RobotNotice missing, displaced;
  missing.robot(4);
  missing.is_missing(true);
  displaced.robot(9);
  displaced.is_displaced(true);
  displaced.x_m(2);
  message.notices({missing, displaced});
  const auto heartbeat = decode(message, kNow);
  REQUIRE(heartbeat);
  CHECK(heartbeat->sender == 10001);
  CHECK(heartbeat->incarnation == 8);
  CHECK(heartbeat->epoch == 7);
  CHECK(heartbeat->mode == msg::CoordinatorMode::COORDINATOR_REGISTERING);
  CHECK(heartbeat->watched_until == kNow);
  CHECK(is_missing(*heartbeat, 4));
  CHECK_FALSE(is_missing(*heartbeat, 9));
  REQUIRE(heartbeat->notices.size() == 2);
  CHECK(heartbeat->notices[1].x_m() == 2);
  message.epoch(0);
  CHECK(decode(message, kNow)->epoch == 0);
}

TEST_CASE("a heartbeat with an invalid position of a displaced robot is refused") {
  msg::CoordinatorState message;
  message.header().sender(10000);
  msg::RobotNotice good;
  good.robot(9);
  good.is_displaced(true);
  message.notices({good});
  REQUIRE(decode(message, kNow));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refuses = [&](auto spoil) {
    msg::RobotNotice notice = good;
    spoil(notice);
    message.notices({notice});
    return !decode(message, kNow);
  };
  CHECK(refuses([&](auto& n) { n.x_m(nan); }));
  CHECK(refuses([&](auto& n) { n.y_m(1e9); }));
  CHECK(refuses([&](auto& n) { n.position_variance_m2(-1); }));
  CHECK(refuses([&](auto& n) { n.position_variance_m2(nan); }));
  CHECK(refuses([&](auto& n) { n.robot(kMaxRobots); }));
  CHECK(refuses([&](auto& n) { n.observed_at_ns(to_ns(kNow) + 3'600'000'000'000); }));
  message.notices({good});
  message.watched_until_ns(to_ns(kNow) + 3'600'000'000'000);
  CHECK_FALSE(decode(message, kNow));
}

TEST_CASE("a heartbeat with an implausible epoch or an unknown mode is refused") {
  const auto now = static_cast<Epoch>(to_ns(kNow));
  constexpr Epoch kHour = 3'600'000'000'000;
  msg::CoordinatorState message;
  message.header().sender(10000);
  for (const Epoch epoch : {now, now + kHour - 1}) {
    message.epoch(epoch);
    CHECK(decode(message, kNow));
  }
  for (const Epoch epoch : {now + kHour, Epoch{1} << 62, Epoch{1} << 63, std::numeric_limits<Epoch>::max()}) {
    message.epoch(epoch);
    CHECK_FALSE(decode(message, kNow));
  }
  message.epoch(now);
  for (const std::uint32_t mode : {static_cast<std::uint32_t>(msg::CoordinatorMode::COORDINATOR_GRANTING) + 1,
                                   std::numeric_limits<std::uint32_t>::max()}) {
    message.coordinator_mode(static_cast<msg::CoordinatorMode>(mode));
    CHECK_FALSE(decode(message, kNow));
  }
}

TEST_CASE("the cause of a coordinator's role is decoded unchanged, and an invalid one is refused") {
  msg::CoordinatorState message;
  message.header().sender(10000);
  for (int i = 0; i <= static_cast<int>(msg::RoleReason::ROLE_SHARED_EPOCH); ++i) {
    CAPTURE(i);
    const RoleCause in{static_cast<msg::RoleReason>(i), 7, Duration{151'000'000}, 99};
    encode(in, message);
    const auto out = decode_role_cause(message);
    REQUIRE(out);
    CHECK(out->reason == in.reason);
    CHECK(out->peer == in.peer);
    CHECK(out->silence == in.silence);
    CHECK(out->learned == in.learned);
    CHECK(describe(*out) != "unknown");
  }
  REQUIRE(decode(message, kNow));
  const auto is_refused = [&](auto spoil) {
    msg::CoordinatorState hostile = message;
    spoil(hostile);
    return !decode_role_cause(hostile) && !decode(hostile, kNow);
  };
  CHECK(is_refused([](auto& m) {
    m.role_reason(
        static_cast<msg::RoleReason>(static_cast<std::uint32_t>(msg::RoleReason::ROLE_SHARED_EPOCH) + 1));
  }));
  CHECK(is_refused([](auto& m) { m.role_peer(kMaxRobots); }));
  CHECK(is_refused([](auto& m) { m.role_silence_ns(-1); }));
}

}  // namespace sidestep::negotiation_codec_test
