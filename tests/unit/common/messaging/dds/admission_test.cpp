// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/admission.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <tuple>

#include "common/random/rng.hpp"
#include "deploy/run/keys/authority.hpp"
#include "tests/catch.hpp"

namespace sidestep::admission_test {

using namespace std::chrono_literals;
using Refusal = Admission::Refusal;

constexpr const char* kVersion = "2.9.1";

Identity identity(const char* text) { return parse_identity(text).value(); }

/// The id of the `number`th participant with this certificate.
ParticipantId id_with(const Certificate& certificate, std::uint16_t number = 1) {
  ParticipantId id{};
  std::ranges::copy(certificate.prefix(), id.begin());
  id[10] = static_cast<std::uint8_t>(number >> 8);
  id[11] = static_cast<std::uint8_t>(number);
  return id;
}

constexpr Time kBegin = time_from_ns(1'800'000'000'000'000'000);

struct Fixture {
  Certificate issue(const char* text, Duration validity = 1h) { return issue(authority, text, validity); }
  Certificate issue(const Authority& issuer, const char* text, Duration validity) {
    const PrivateKey key = make_private_key();
    const Certificate certificate = issuer.issue(identity(text), key, now, now + validity);
    keys[certificate.serial()] = key;
    return certificate;
  }
  /// The announcement signed with the certificate's own key. Each announcement is signed only once.
  const std::vector<std::uint8_t>& announced(const ParticipantId& id, const Certificate& certificate,
                                             const std::string& version = kVersion,
                                             std::optional<Time> given_start = std::nullopt) {
    // A participant with a higher number started earlier, unless `given_start` is set.
    const Time started = given_start.value_or(kBegin - Duration((id[10] << 8 | id[11]) * 1'000));
    const std::string serial = certificate.serial();
    auto& result = announcements[{id, serial, version, started}];
    if (result.empty()) result = credentials(certificate, keys.at(serial), version, id, started);
    return result;
  }
  Refusal announce(const ParticipantId& id, const Certificate& certificate,
                   const std::string& version = kVersion, std::optional<Time> started = std::nullopt) {
    return admission.on_announcement(id, announced(id, certificate, version, started), now).refusal;
  }

  Time now = kBegin;
  std::map<std::string, PrivateKey> keys;
  std::map<std::tuple<ParticipantId, std::string, std::string, Time>, std::vector<std::uint8_t>>
      announcements;
  Authority authority{"identity authority", now, now + 24h};
  Authority other{"identity authority", now, now + 24h};
  Admission admission{identity("coordinator 0"), authority.certificate(), kVersion};
};

TEST_CASE("only user data in the form of credentials announces keys") {
  const std::vector<std::uint8_t> marked{'S', 'k', 'y', '2', 5}, other{'S', 'k', 'y', '1', 5},
      cut{'S', 'k', 'y'};
  CHECK(announces_keys(marked));
  CHECK_FALSE(announces_keys(other));
  CHECK_FALSE(announces_keys(cut));
  CHECK_FALSE(announces_keys({}));
}

TEST_CASE("a participant with a valid certificate is admitted and identified") {
  Fixture f;
  const Certificate agent = f.issue("agent 3");
  const ParticipantId id = id_with(agent);
  CHECK_FALSE(f.admission.admits(id, f.now));
  CHECK(f.admission.identity_of(id) == nullptr);
  CHECK(f.announce(id, agent) == Refusal::kNone);
  CHECK(f.admission.admits(id, f.now));
  REQUIRE(f.admission.identity_of(id) != nullptr);
  CHECK(*f.admission.identity_of(id) == identity("agent 3"));
}

TEST_CASE("participants without a valid certificate of this network are refused") {
  Fixture f;
  const Certificate agent = f.issue("agent 3"), foreign = f.issue(f.other, "agent 3", 1h);
  const ParticipantId id = id_with(agent);
  const auto refusal = [&](const std::vector<std::uint8_t>& announced) {
    return f.admission.on_announcement(id, announced, f.now).refusal;
  };
  CHECK(refusal({}) == Refusal::kNoCredentials);
  CHECK(refusal({'S', 'k', 'y', '2'}) == Refusal::kNoCredentials);
  CHECK(refusal({'S', 'k', 'y', '2', 9, '2'}) == Refusal::kNoCredentials);
  CHECK(refusal({'S', 'k', 'y', '2', 1, '2', 1, 0, 0}) == Refusal::kNoCredentials);
  CHECK(refusal({'S', 'k', 'y', '2', 1, '2', 8, 0, 0, 0, 0, 0, 0, 0, 0, 0}) == Refusal::kNoCertificate);
  CHECK(f.announce(id, foreign) == Refusal::kOtherAuthority);
  f.keys[f.authority.certificate().serial()] = f.authority.key();
  CHECK(f.announce(id_with(f.authority.certificate()), f.authority.certificate()) ==
        Refusal::kUnknownSubject);
  CHECK(f.announce(id_with(f.issue("agent 4")), agent) == Refusal::kOtherPrefix);
  CHECK(f.announce(id, agent, "3.1.2") == Refusal::kOtherVersion);
  CHECK(f.announce(id, agent, "2.14.0") == Refusal::kNone);
}

TEST_CASE("an announcement with one flipped bit is refused") {
  Fixture f;
  const Certificate agent = f.issue("agent 3");
  const std::vector<std::uint8_t> genuine = f.announced(id_with(agent), agent);
  const std::uint64_t seed = 43;
  CAPTURE(seed);
  Rng rng(seed);
  for (int i = 0; i < 500; ++i) {
    f.now += 1s;  // stays below the limit on signature checks
    std::vector<std::uint8_t> changed = genuine;
    // The version text is not signed.
    const std::size_t bit = 8 * 10 + rng.below(8 * (genuine.size() - 10));
    CAPTURE(bit);
    changed[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    CHECK(f.admission.on_announcement(id_with(agent), changed, f.now).refusal != Refusal::kNone);
  }
}

TEST_CASE("an announcement is valid for only one participant") {
  Fixture f;
  const Certificate agent = f.issue("agent 3"), thief = f.issue("agent 4");
  const ParticipantId id = id_with(agent, 1), other = id_with(agent, 2);
  const auto refusal = [&](const ParticipantId& who, const std::vector<std::uint8_t>& announced) {
    return f.admission.on_announcement(who, announced, f.now).refusal;
  };
  CHECK(refusal(other, f.announced(id, agent)) == Refusal::kOtherSignature);
  // A signature is not valid for another key or another start time.
  CHECK(refusal(id, credentials(agent, f.keys.at(thief.serial()), kVersion, id, f.now)) ==
        Refusal::kOtherSignature);
  std::vector<std::uint8_t> later = f.announced(id, agent);
  const std::size_t start_at = 4 + 1 + std::string(kVersion).size() + 1;
  later[start_at] ^= 1;
  CHECK(refusal(id, later) == Refusal::kOtherSignature);
  CHECK_FALSE(f.admission.admits(id, f.now));
  CHECK_FALSE(f.admission.admits(other, f.now));
  CHECK(refusal(id, f.announced(id, agent)) == Refusal::kNone);
}

TEST_CASE("a flood of made-up participants delays a genuine participant but does not keep it out") {
  Fixture f;
  const Certificate robot = f.issue("agent 3"), idle = f.issue("agent 4");
  const bool is_known = GENERATE(true, false);
  if (is_known) REQUIRE(f.announce(id_with(robot, 1), robot) == Refusal::kNone);
  const std::uint64_t seed = 3;
  CAPTURE(is_known, seed);
  Rng rng(seed);
  REQUIRE(f.announce(id_with(idle), idle) == Refusal::kNone);
  std::vector<std::uint8_t> made_up = f.announced(id_with(idle), idle);
  const ParticipantId genuine = id_with(robot, 2);
  constexpr int kPerSecond = 10'000, kMaxSeconds = 120;
  int seconds = 0, admitted = 0;
  for (bool is_admitted = false; !is_admitted && seconds < kMaxSeconds; ++seconds) {
    const auto turn = static_cast<int>(rng.below(kPerSecond));
    for (int i = 0; i < kPerSecond; ++i, f.now += Duration(1s) / kPerSecond) {
      if (i == turn) is_admitted = f.announce(genuine, robot) == Refusal::kNone;
      const ParticipantId id = id_with(idle, static_cast<std::uint16_t>(2 + rng.below(60'000)));
      admitted += f.admission.on_announcement(id, made_up, f.now).refusal == Refusal::kNone;
    }
  }
  INFO("waited " << seconds << " s");
  CHECK(seconds < kMaxSeconds);
  CHECK(admitted == 0);
}

TEST_CASE("a certificate is accepted only while it is valid") {
  Fixture f;
  const Certificate agent = f.issue("agent 3", 60s);
  const ParticipantId id = id_with(agent);
  f.now -= 1s;
  CHECK(f.announce(id, agent) == Refusal::kNotValidNow);
  f.now += 2s;
  CHECK(f.announce(id, agent) == Refusal::kNone);
  f.now += 58s;
  CHECK(f.announce(id, agent) == Refusal::kNone);
  CHECK(f.admission.newly_refused(f.now).empty());
  f.now += 2s;
  CHECK(f.admission.newly_refused(f.now) == std::vector{id});
  CHECK_FALSE(f.admission.admits(id, f.now));
  CHECK(f.announce(id, agent) == Refusal::kNotValidNow);
}

TEST_CASE("a revoked key is refused, even for a participant that was already admitted") {
  Fixture f;
  const Certificate agent = f.issue("agent 3"), newer = f.issue("agent 3");
  const ParticipantId id = id_with(agent);
  CHECK(f.announce(id, agent) == Refusal::kNone);
  f.admission.revoke({agent.serial()});
  CHECK(f.admission.newly_refused(f.now) == std::vector{id});
  CHECK(f.admission.newly_refused(f.now).empty());
  CHECK_FALSE(f.admission.admits(id, f.now));
  CHECK(f.announce(id, agent) == Refusal::kRevoked);
  CHECK(f.announce(id, newer) == Refusal::kNone);
}

TEST_CASE("participants that exchange no messages do not authenticate each other") {
  Fixture f;
  Admission agent(identity("agent 1"), f.authority.certificate(), kVersion);
  const auto refusal = [&](const char* text) {
    const Certificate certificate = f.issue(text);
    const ParticipantId id = id_with(certificate);
    return agent.on_announcement(id, f.announced(id, certificate), f.now).refusal;
  };
  CHECK(refusal("agent 2") == Refusal::kNotNeeded);
  CHECK(refusal("robot 2-4") == Refusal::kNotNeeded);
  CHECK(refusal("robot 1") == Refusal::kNone);
  CHECK(refusal("coordinator 0") == Refusal::kNone);
  CHECK(refusal("agent 1") == Refusal::kNone);  // itself, or a second process with the same identity
}

TEST_CASE("only silent participants are forgotten") {
  Fixture f;
  const Certificate silent = f.issue("agent 3"), other = f.issue("agent 4");
  CHECK(f.announce(id_with(silent), silent) == Refusal::kNone);
  CHECK(f.announce(id_with(other), other) == Refusal::kNone);
  for (int i = 0; i < 11; ++i) {
    f.now += 1s;
    CHECK(f.admission.admits(id_with(other), f.now));
  }
  CHECK(f.admission.newly_refused(f.now) == std::vector{id_with(silent)});
}

TEST_CASE("participants that share a certificate cannot displace all other participants") {
  Fixture f;
  const Certificate thief = f.issue("agent 3"), other = f.issue("agent 4");
  for (std::uint16_t i = 0; i < 2000; ++i, f.now += 3ms)
    REQUIRE(f.announce(id_with(thief, i), thief) ==
            (i < Admission::kMaxPerCertificate ? Refusal::kNone : Refusal::kTooMany));
  CHECK(f.announce(id_with(other), other) == Refusal::kNone);
}

TEST_CASE("unauthenticated participants are admitted at a low rate, and authenticated ones at any rate") {
  Fixture f;
  const Certificate thief = f.issue("agent 3"), other = f.issue("agent 4");
  std::uint16_t strangers = 0, admitted = 0, genuine = 0;
  constexpr int kMinutes = 10;
  for (int second = 0; second < 60 * kMinutes; ++second) {
    f.now += 1s;
    for (int i = 0; i < 10; ++i) admitted += f.announce(id_with(thief, strangers++), thief) == Refusal::kNone;
    // A genuine process may start often, like an operator's commands, each of which ends soon.
    const ParticipantId command = id_with(other, genuine++);
    REQUIRE(f.announce(command, other) == Refusal::kNone);
    f.admission.on_authenticated(command);
    f.admission.on_authenticated(command);
    (void)f.admission.newly_refused(f.now);
  }
  CHECK(admitted > 100);
  CHECK(admitted <= Admission::kMaxPerCertificate + 60 * kMinutes / 5 + 2);
}

TEST_CASE("replayed announcements delay a genuine restart by a bounded time") {
  Fixture f;
  const Certificate robot = f.issue("agent 3"), idle = f.issue("agent 4");
  const int strangers = GENERATE(24, 40, 400), attacked_for_s = GENERATE(0, 600);
  // If the clock of a host was set back, its latest process does not have the highest start time.
  const bool is_clock_right = GENERATE(true, false);
  CAPTURE(strangers, attacked_for_s, is_clock_right);
  // Announces all strangers. This happens once a second, before the genuine process announces itself.
  // Returns the number of admitted strangers.
  const auto strangers_announce = [&] {
    int admitted = 0;
    for (int i = 0; i < strangers; ++i)
      admitted += f.announce(id_with(robot, static_cast<std::uint16_t>(i)), robot) == Refusal::kNone;
    return admitted;
  };
  // A genuine participant stays admitted during the whole attack.
  const ParticipantId twin = id_with(robot, 50'000), restarted = id_with(robot, 50'001);
  REQUIRE(f.announce(twin, robot, kVersion, kBegin + 1s) == Refusal::kNone);
  f.admission.on_authenticated(twin);
  f.now += 30min;
  for (int second = 0; second <= attacked_for_s; ++second, f.now += 1s) {
    REQUIRE(f.admission.admits(twin, f.now));
    // A stranger that has been heard may still be displaced.
    REQUIRE(strangers_announce() <= static_cast<int>(Admission::kMaxPerCertificate) + 1);
    static_cast<void>(f.admission.newly_refused(f.now));
  }
  int waited_s = 0;
  const Time restarted_at = is_clock_right ? f.now : kBegin - 1h;
  for (; f.announce(restarted, robot, kVersion, restarted_at) != Refusal::kNone; ++waited_s, f.now += 1s) {
    REQUIRE(waited_s < 5 * strangers);
    REQUIRE(f.admission.admits(twin, f.now));
    strangers_announce();
    static_cast<void>(f.admission.newly_refused(f.now));
  }
  INFO("waited " << waited_s << " s");
  // With a wrong clock, in the worst case every stranger is admitted first, one per kUnauthenticatedPeriod.
  CHECK(waited_s <= (is_clock_right ? 0 : strangers <= 40 ? 20 : 5 * strangers));
}

TEST_CASE("a process that was silent for a while does not wait behind replayed announcements") {
  Fixture f;
  const Certificate robot = f.issue("agent 3", 24h);
  const ParticipantId genuine = id_with(robot, 50'000);
  const Time started = kBegin + 1s;
  REQUIRE(f.announce(genuine, robot, kVersion, started) == Refusal::kNone);
  f.admission.on_authenticated(genuine);
  const auto others_announce = [&] {
    for (std::uint16_t i = 0; i < 400; ++i) static_cast<void>(f.announce(id_with(robot, i), robot));
  };
  bool was_forgotten = false;
  for (int second = 0; second < 60; ++second, f.now += 1s) {
    others_announce();
    for (const ParticipantId& id : f.admission.newly_refused(f.now))
      was_forgotten = was_forgotten || id == genuine;
  }
  REQUIRE(was_forgotten);
  CHECK(f.announce(genuine, robot, kVersion, started) == Refusal::kNone);
}

TEST_CASE("if many processes with one key start together, the latest ones stay admitted") {
  Fixture f;
  const Certificate op = f.issue("operator");
  const auto start = [&](std::uint16_t i) { return kBegin + i * Duration(10ms); };
  for (std::uint16_t i = 0; i < 40; ++i, f.now += 10ms) {
    REQUIRE(f.announce(id_with(op, i), op, kVersion, start(i)) == Refusal::kNone);
    REQUIRE(f.admission.admits(id_with(op, i), f.now));
  }
  for (std::uint16_t i = 0; i < 40; ++i) {
    CAPTURE(i);
    CHECK(f.admission.admits(id_with(op, i), f.now) == (i >= 40 - Admission::kMaxPerCertificate));
  }
}

TEST_CASE("a start time far in the future does not count as the latest") {
  Fixture f;
  const Certificate robot = f.issue("agent 3", 24h);
  REQUIRE(f.announce(id_with(robot, 1), robot, kVersion, kBegin + 365 * 24h) == Refusal::kNone);
  f.now += 30min;
  for (std::uint16_t i = 2; i < 100; ++i) static_cast<void>(f.announce(id_with(robot, i), robot));
  CHECK(f.announce(id_with(robot, 200), robot, kVersion, f.now) == Refusal::kNone);
  // Start times that are impossible do no harm either.
  for (const auto ns : {std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()})
    CHECK(f.announce(id_with(robot, 300), robot, kVersion, time_from_ns(ns)) == Refusal::kTooMany);
}

TEST_CASE("participants with many stolen certificates are displaced by a genuine participant") {
  Fixture f;
  std::vector<Certificate> stolen;
  for (std::size_t i = 0; i * Admission::kMaxPerCertificate < Admission::kMaxParticipants; ++i)
    stolen.push_back(f.issue(("agent " + std::to_string(10 + i)).c_str()));
  const auto strangers_announce = [&] {
    for (const Certificate& certificate : stolen)
      for (std::uint16_t i = 0; i < Admission::kMaxPerCertificate; ++i, f.now += 4ms)
        static_cast<void>(f.announce(id_with(certificate, i), certificate));
  };
  f.now += 10s;
  strangers_announce();
  const Certificate robot = f.issue("agent 3");
  CHECK(f.announce(id_with(robot), robot) == Refusal::kTooMany);
  f.now += Admission::kMaxUnproven - 4s;
  CHECK(f.announce(id_with(robot), robot) == Refusal::kNone);
  CHECK(f.admission.newly_refused(f.now).size() == 1);
}

TEST_CASE("a displaced participant waits longer each time until it proves that it is genuine") {
  Fixture f;
  const Certificate robot = f.issue("agent 3", 24h);
  const ParticipantId slow = id_with(robot, 60'000);
  std::uint16_t next = 0;
  const auto displace = [&] {
    while (f.admission.identity_of(slow)) {
      f.now += 1s;
      static_cast<void>(f.announce(id_with(robot, next++), robot));
    }
  };
  const auto wait = [&] {
    const Time since = f.now;
    while (f.announce(slow, robot) != Refusal::kNone) f.now += 1s;
    return f.now - since;
  };
  REQUIRE(wait() == 0s);
  displace();
  CHECK(f.admission.newly_refused(f.now).front() == slow);
  const Duration first = wait();
  CHECK(first >= Admission::kFirstWait);
  CHECK(first <= Admission::kFirstWait + Admission::kUnauthenticatedPeriod);
  displace();
  const Duration second = wait();
  CHECK(second >= 2 * Admission::kFirstWait);
  CHECK(second <= 2 * Admission::kFirstWait + Admission::kUnauthenticatedPeriod);
  f.admission.on_authenticated(slow);
  for (int i = 0; i < 100; ++i, f.now += 1s) {
    REQUIRE(f.admission.admits(slow, f.now));
    static_cast<void>(f.announce(id_with(robot, next++), robot));
  }
}

TEST_CASE("the number of signature checks is limited, and known certificates need none") {
  Fixture f;
  const Certificate known = f.issue("agent 3");
  CHECK(f.announce(id_with(known), known) == Refusal::kNone);
  int checked = 0;
  for (int i = 0; i < 2000; ++i) {
    std::vector<std::uint8_t> announced = f.announced(id_with(known), known);
    announced.back() ^= 1;
    checked +=
        f.admission.on_announcement(id_with(known), announced, f.now).refusal == Refusal::kOtherAuthority;
  }
  // Two checks went to the known participant's certificate and announcement.
  CHECK(checked == Admission::kMaxChecks - 2);
  CHECK(f.announce(id_with(known), known) == Refusal::kNone);
  const Certificate fresh = f.issue("agent 4");
  CHECK(f.announce(id_with(fresh), fresh) == Refusal::kTooFast);
  f.now += 1s;
  CHECK(f.announce(id_with(fresh), fresh) == Refusal::kNone);
}

TEST_CASE("unused certificates are dropped to make room for later ones") {
  Fixture f;
  const Certificate first = f.issue("agent 3", 24h);
  CHECK(f.announce(id_with(first), first) == Refusal::kNone);
  for (int i = 0; i < 5000; ++i) {
    f.now += 20ms;
    const Certificate later = f.issue("agent 4", 24h);
    const ParticipantId id = id_with(later);
    CHECK(f.announce(id, later) == Refusal::kNone);
    f.admission.on_authenticated(id);
    CHECK(f.admission.admits(id_with(first), f.now));  // the participant is heard, so it is not forgotten
    if (i % 100 == 0) static_cast<void>(f.admission.newly_refused(f.now));
  }
  REQUIRE(f.admission.identity_of(id_with(first)));
  CHECK(to_text(*f.admission.identity_of(id_with(first))) == "agent 3");
}

TEST_CASE("a participant that cannot prove that its certificate is its own is reported once") {
  Fixture f;
  const Certificate genuine = f.issue("agent 3"), impostor = f.issue("agent 4"),
                    self = f.issue("coordinator 0");
  const Certificate brief = f.issue("agent 5");
  f.admission.set_self(id_with(self));
  for (const Certificate* certificate : {&genuine, &impostor, &self, &brief})
    CHECK(f.announce(id_with(*certificate), *certificate) == Refusal::kNone);
  f.admission.on_authenticated(id_with(genuine));
  f.now += Admission::kMaxUnproven - 1s;
  for (const Certificate* certificate : {&genuine, &impostor, &self})
    CHECK(f.admission.admits(id_with(*certificate), f.now));
  CHECK(f.admission.newly_unauthenticated(f.now).empty());
  f.now += 1s;
  CHECK(f.admission.newly_unauthenticated(f.now) == std::vector{identity("agent 4")});
  CHECK(f.admission.newly_unauthenticated(f.now).empty());
}

TEST_CASE("refusals are described in plain words") {
  CHECK(Admission::describe({Refusal::kRevoked, "agent 3"}, "10.0.0.7") ==
        "agent 3 at 10.0.0.7, whose key is revoked");
  CHECK(Admission::describe({Refusal::kNoCredentials}, "10.0.0.7") ==
        "a process at 10.0.0.7 that announces no key: start it with --keys");
  CHECK(Admission::describe({Refusal::kOtherPrefix, "agent 3"}, "10.0.0.7") ==
        "a process at 10.0.0.7 that announces the certificate of agent 3");
}

}  // namespace sidestep::admission_test
