// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "common/keys/certificate.hpp"
#include "common/keys/private_key.hpp"
#include "common/messaging/dds/presence.hpp"
#include "common/time/rate_limit.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// The user data that a participant with keys announces: the version of Fast DDS, its start time, its
/// certificate, and a signature by its private key, which makes the announcement valid for this id only.
std::vector<std::uint8_t> credentials(const Certificate& certificate, const PrivateKey& key,
                                      const std::string& version, const ParticipantId& id, Time started);

/// Whether a participant's user data has the form of credentials(): it has keys, genuine or not.
[[nodiscard]] bool announces_keys(std::span<const std::uint8_t> user_data);

/// Decides which participants a process with keys listens to, and stores their identities.
///
/// Fast DDS authenticates participants, but does not report their identities, stores every participant's
/// announcements, and reads the list of revoked keys only at its start. Participants therefore announce their
/// certificate. The prefix of a participant's GUID depends on the certificate, and Fast DDS checks that the
/// owner of the GUID has the certificate's private key. The decisions made here therefore hold for all
/// participants that Fast DDS accepts. An attacker cannot sign an announcement. It can replay another
/// participant's announcement, but then fails to authenticate. Therefore the number of participants with one
/// certificate is limited. All participants except the latest to start are admitted at a low rate until they
/// have authenticated, because Fast DDS keeps about a hundred bytes for each participant until the process
/// ends. If no place is left, a new participant displaces a participant that has not authenticated in time.
/// The displaced participant must wait before it is admitted again, twice as long each time. Only the owner
/// of the private key can announce a later start, so a genuine process that restarts does not wait.
/// Participants that exchange no messages, such as two agents, do not admit each other: with many robots,
/// their handshakes would take most of the start-up time.
class Admission {
 public:
  static constexpr std::size_t kMaxPerCertificate = 24;
  /// Interval between admissions of participants that have not authenticated yet, beyond the first
  /// kMaxPerCertificate.
  static constexpr Duration kUnauthenticatedPeriod{5'000'000'000};
  static constexpr std::size_t kMaxParticipants = 1024;
  /// Silence after which a participant is forgotten. Announcements arrive once a second.
  static constexpr Duration kForgetAfter{10'000'000'000};
  /// Time within which Fast DDS has authenticated a genuine participant.
  static constexpr Duration kMaxUnproven{8'000'000'000};
  /// A start time farther in the future than this does not count as the latest: it comes from a wrong clock,
  /// and would remain the latest until then.
  static constexpr Duration kMaxAhead{600'000'000'000};
  /// Time for which a displaced participant is not admitted again: after its first displacement, and at most.
  /// The first wait is short, because a genuine participant may be slow on a busy machine.
  static constexpr Duration kFirstWait{10'000'000'000}, kMaxWait{3'600'000'000'000};
  /// Limits how many signatures of certificates and announcements are checked: in a burst, then per second.
  static constexpr int kMaxChecks = 400, kChecksPerSecond = 400;

  enum class Refusal : std::uint8_t {
    kNone,
    kNotNeeded,  ///< the participant and this process exchange no messages
    kNoCredentials,
    kOtherVersion,
    kNoCertificate,
    kOtherAuthority,
    kUnknownSubject,
    kOtherPrefix,
    kOtherSignature,
    kNotValidNow,
    kRevoked,
    kTooMany,
    kTooFast
  };

  struct Decision {
    Refusal refusal = Refusal::kNone;
    std::string who{};  ///< identity in the certificate, e.g. "agent 3"; empty: unknown
  };

  /// `version` is that of this process's Fast DDS. A process admits itself.
  Admission(Identity self, Certificate authority, std::string version);

  /// The id of this process's own participant, which need not authenticate itself.
  void set_self(const ParticipantId& id) { self_id_ = id; }
  /// Processes a participant's announcement: untrusted bytes in the format of credentials().
  [[nodiscard]] Decision on_announcement(const ParticipantId& id, std::span<const std::uint8_t> announced,
                                         Time now);
  /// Whether datagrams of the participant may be passed on. Call on_announcement() first.
  [[nodiscard]] bool admits(const ParticipantId& id, Time now);
  /// The participant's identity; nullptr if it is not admitted.
  const Identity* identity_of(const ParticipantId& id) const;
  /// Fast DDS has accepted the participant's private key and permissions.
  void on_authenticated(const ParticipantId& id);
  /// The identities of participants that were admitted at least kMaxUnproven ago but have not authenticated.
  /// Each participant is returned once.
  [[nodiscard]] std::vector<Identity> newly_unauthenticated(Time now);
  /// Adds serial numbers of revoked certificates. Revocations are never undone.
  void revoke(const std::set<std::string>& serials) { revoked_.insert(serials.begin(), serials.end()); }
  const std::set<std::string>& revoked() const { return revoked_; }
  /// Participants that have lost their admission since the last call, because they are silent or were
  /// displaced, or because their certificate has expired or was revoked. Fast DDS must forget them.
  [[nodiscard]] std::vector<ParticipantId> newly_refused(Time now);

  /// The refusal in plain words: "agent 3 at 10.0.0.7, whose key is revoked".
  static std::string describe(const Decision& decision, const std::string& address);

 private:
  struct Announced;
  struct Known {
    Identity identity;
    Certificate certificate;
    std::string serial;
    CertifiedPrefix prefix;
    bool is_needed;
    Time not_before, not_after;
    RateLimit unproven{kMaxPerCertificate, kUnauthenticatedPeriod};
    Time announced{};     ///< time of the last announcement
    Time latest_start{};  ///< latest start of an admitted participant, not ahead of the clock
  };
  struct Participant {
    Known* known = nullptr;
    Time admitted, last_heard, start;
    bool was_latest = false;  ///< its admission did not count against Known::unproven
    bool is_authenticated = false, is_reported = false;
  };
  struct Displaced {
    Time since, until;  ///< not admitted again before `until`
  };

  /// Forgets the certificate that was announced longest ago, unless a participant uses it.
  void forget_oldest();
  /// The certificate, if the authority has issued it; otherwise sets `refusal` and returns nullptr.
  Known* find_known(std::span<const std::uint8_t> der, Time now, Refusal& refusal);
  Refusal admit(const ParticipantId& id, Known& known, const Announced& announced, Time now);
  /// Makes room for one more participant with this certificate. Displaces a participant that has not
  /// authenticated in time. The latest participant of a certificate may also displace any other participant
  /// of that certificate that has not authenticated yet. Returns false if there is no such participant.
  bool make_room(const Known& known, bool is_latest, Time now);
  void displace(const ParticipantId& id, Time now);
  Refusal check_now(const Known& known, Time now) const;
  bool is_in_use(const Known& known) const;

  const Identity self_;
  std::optional<ParticipantId> self_id_;
  const Certificate authority_;
  const std::string version_;
  std::set<std::string> revoked_;
  std::map<std::string, Known> known_;  ///< keyed by certificate (DER); only the authority's
  std::map<ParticipantId, Participant> participants_;
  std::map<ParticipantId, Displaced> displaced_;     ///< at most kMaxParticipants; the oldest are forgotten
  std::vector<ParticipantId> displaced_since_call_;  ///< since the last call of newly_refused()
  RateLimit checks_{kMaxChecks, std::chrono::microseconds(1'000'000 / kChecksPerSecond)};
};

}  // namespace sidestep
