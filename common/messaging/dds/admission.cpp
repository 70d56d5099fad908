// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/admission.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <stdexcept>
#include <utility>

#include "common/messaging/topic_access.hpp"

namespace sidestep {
namespace {

constexpr std::array<std::uint8_t, 4> kMark{'S', 'k', 'y', '2'};
constexpr std::size_t kMaxKnown = 4096;

/// Appends a part of at most 255 bytes, preceded by its size.
void append_part(std::vector<std::uint8_t>& bytes, std::span<const std::uint8_t> part) {
  if (part.size() > 255)
    throw std::invalid_argument(
        fmt::format("keys: expected a signature of at most 255 bytes, got {}: use a key on the curve P-256",
                    part.size()));
  bytes.push_back(static_cast<std::uint8_t>(part.size()));
  bytes.insert(bytes.end(), part.begin(), part.end());
}

/// Removes a part written by append_part() from the front and returns it.
std::optional<std::span<const std::uint8_t>> read_part(std::span<const std::uint8_t>& bytes) {
  if (bytes.empty() || bytes.size() - 1 < bytes[0]) return std::nullopt;
  const std::span<const std::uint8_t> part = bytes.subspan(1, bytes[0]);
  bytes = bytes.subspan(1 + part.size());
  return part;
}

/// The bytes that the owner of a private key signs: the participant and its start time. A mark at the
/// beginning distinguishes these bytes from everything else that the key signs.
std::vector<std::uint8_t> signed_part(const ParticipantId& id, std::span<const std::uint8_t> start) {
  std::vector<std::uint8_t> result(kMark.size() + id.size() + start.size());
  auto end = std::ranges::copy(kMark, result.begin()).out;
  end = std::ranges::copy(id, end).out;
  std::ranges::copy(start, end);
  return result;
}

/// Bytes in little-endian order.
std::array<std::uint8_t, 8> bytes_of(Time time) {
  std::array<std::uint8_t, 8> result{};
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(to_ns(time)) >> 8 * i);
  return result;
}

Time time_of(std::span<const std::uint8_t> bytes) {
  std::uint64_t ns = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) ns |= std::uint64_t{bytes[i]} << 8 * i;
  return time_from_ns(static_cast<std::int64_t>(ns));
}

/// The major version. Versions with equal major versions can communicate.
std::string first_number(const std::string& version) { return version.substr(0, version.find('.')); }

const char* reason_text(Admission::Refusal refusal) {
  using Refusal = Admission::Refusal;
  switch (refusal) {
    case Refusal::kNone:
    case Refusal::kNotNeeded:
    case Refusal::kOtherPrefix:
    case Refusal::kOtherSignature:
      return "";
    case Refusal::kNoCredentials:
      return " that announces no key: start it with --keys";
    case Refusal::kOtherVersion:
      return " that uses another version of Fast DDS: processes with keys understand only their own version";
    case Refusal::kNoCertificate:
      return ", whose announcement has no valid certificate";
    case Refusal::kOtherAuthority:
      return ", whose key was issued by another authority";
    case Refusal::kUnknownSubject:
      return ", whose certificate names no identity of Sidestep";
    case Refusal::kNotValidNow:
      return ", whose key has expired, or is not valid yet";
    case Refusal::kRevoked:
      return ", whose key is revoked";
    case Refusal::kTooMany:
      return ", because too many participants have the same key";
    case Refusal::kTooFast:
      return ", because too many processes announce themselves at once";
  }
  return "";
}

bool has_prefix(const ParticipantId& id, const CertifiedPrefix& prefix) {
  return std::equal(prefix.begin(), prefix.end(), id.begin());
}

}  // namespace

/// The parsed content of credentials().
struct Admission::Announced {
  std::string version;
  std::span<const std::uint8_t> start, signature, certificate;

  static std::optional<Announced> parse(std::span<const std::uint8_t> bytes) {
    if (!announces_keys(bytes)) return std::nullopt;
    bytes = bytes.subspan(kMark.size());
    const auto version = read_part(bytes), start = version ? read_part(bytes) : std::nullopt,
               signature = start ? read_part(bytes) : std::nullopt;
    if (!signature || start->size() != sizeof(std::int64_t)) return std::nullopt;
    return Announced{std::string(version->begin(), version->end()), *start, *signature, bytes};
  }
};

std::vector<std::uint8_t> credentials(const Certificate& certificate, const PrivateKey& key,
                                      const std::string& version, const ParticipantId& id, Time started) {
  std::vector<std::uint8_t> result(kMark.begin(), kMark.end());
  const auto start = bytes_of(started);
  append_part(result, std::vector<std::uint8_t>(version.begin(), version.end()));
  append_part(result, start);
  append_part(result, sign(key, signed_part(id, start)));
  const std::vector<std::uint8_t> der = certificate.der();
  result.insert(result.end(), der.begin(), der.end());
  return result;
}

bool announces_keys(std::span<const std::uint8_t> user_data) {
  return user_data.size() >= kMark.size() && std::ranges::equal(kMark, user_data.first(kMark.size()));
}

Admission::Admission(Identity self, Certificate authority, std::string version)
    : self_(std::move(self)), authority_(std::move(authority)), version_(std::move(version)) {}

Admission::Decision Admission::on_announcement(const ParticipantId& id,
                                               std::span<const std::uint8_t> announced, Time now) {
  const auto parsed = Announced::parse(announced);
  if (!parsed) return {Refusal::kNoCredentials};
  Refusal refusal = Refusal::kNone;
  Known* const known = find_known(parsed->certificate, now, refusal);
  if (!known) return {refusal};
  return {admit(id, *known, *parsed, now), to_text(known->identity)};
}

Admission::Refusal Admission::admit(const ParticipantId& id, Known& known, const Announced& announced,
                                    Time now) {
  if (!has_prefix(id, known.prefix)) return Refusal::kOtherPrefix;
  if (const Refusal refusal = check_now(known, now); refusal != Refusal::kNone) return refusal;
  if (!known.is_needed) return Refusal::kNotNeeded;
  if (first_number(announced.version) != first_number(version_)) return Refusal::kOtherVersion;
  if (const auto found = participants_.find(id); found != participants_.end()) {
    found->second.last_heard = now;
    return Refusal::kNone;
  }
  const auto displaced = displaced_.find(id);
  if (displaced != displaced_.end() && now < displaced->second.until) return Refusal::kTooMany;
  const Time start = time_of(announced.start);
  // Equality includes the latest participant itself, which may return after a silence.
  const bool is_latest = start >= known.latest_start && start < now + kMaxAhead;
  if (!is_latest && !known.unproven.admit(now)) return Refusal::kTooMany;
  const auto refuse = [&](Refusal refusal) {
    if (!is_latest) known.unproven.refund();
    return refusal;
  };
  if (!checks_.admit(now)) return refuse(Refusal::kTooFast);
  if (!known.certificate.has_signed(signed_part(id, announced.start), announced.signature))
    return refuse(Refusal::kOtherSignature);
  if (!make_room(known, is_latest, now)) return refuse(Refusal::kTooMany);
  if (is_latest) known.latest_start = start;
  participants_[id] = {&known, now, now, start, is_latest};
  return Refusal::kNone;
}

bool Admission::make_room(const Known& known, bool is_latest, Time now) {
  const auto has_certificate = [&known](const auto& p) { return p.second.known == &known; };
  const auto same = static_cast<std::size_t>(std::ranges::count_if(participants_, has_certificate));
  const bool is_certificate_full = same >= kMaxPerCertificate;
  if (!is_certificate_full && participants_.size() < kMaxParticipants) return true;
  auto oldest = participants_.end();  // the participant that started first
  for (auto entry = participants_.begin(); entry != participants_.end(); ++entry) {
    const Participant& participant = entry->second;
    if (is_certificate_full && participant.known != &known) continue;
    if (participant.is_authenticated || entry->first == self_id_) continue;
    const bool is_old = now - participant.admitted >= kMaxUnproven;
    if (!is_old && !(is_latest && participant.known == &known)) continue;
    if (oldest == participants_.end() || participant.start < oldest->second.start) oldest = entry;
  }
  if (oldest == participants_.end()) return false;
  displace(oldest->first, now);
  participants_.erase(oldest);
  return true;
}

void Admission::displace(const ParticipantId& id, Time now) {
  displaced_since_call_.push_back(id);
  const auto found = displaced_.find(id);
  if (found != displaced_.end()) {
    const Duration wait = std::min(2 * (found->second.until - found->second.since), kMaxWait);
    found->second = {now, now + wait};
    return;
  }
  if (displaced_.size() >= kMaxParticipants)
    displaced_.erase(std::ranges::min_element(displaced_, {}, [](const auto& d) { return d.second.since; }));
  displaced_[id] = {now, now + kFirstWait};
}

bool Admission::admits(const ParticipantId& id, Time now) {
  const auto found = participants_.find(id);
  if (found == participants_.end()) return false;
  found->second.last_heard = now;
  return true;
}

const Identity* Admission::identity_of(const ParticipantId& id) const {
  const auto found = participants_.find(id);
  return found == participants_.end() ? nullptr : &found->second.known->identity;
}

void Admission::on_authenticated(const ParticipantId& id) {
  const auto found = participants_.find(id);
  if (found == participants_.end() || found->second.is_authenticated) return;
  found->second.is_authenticated = true;
  displaced_.erase(id);
  if (!found->second.was_latest) found->second.known->unproven.refund();
}

std::vector<Identity> Admission::newly_unauthenticated(Time now) {
  std::vector<Identity> result;
  for (auto& [id, participant] : participants_) {
    if (participant.is_authenticated || participant.is_reported || now - participant.admitted < kMaxUnproven)
      continue;
    participant.is_reported = true;
    // A participant that has already ended may have lived too briefly to authenticate.
    if (id == self_id_ || now - participant.last_heard > kMaxUnproven / 2) continue;
    result.push_back(participant.known->identity);
  }
  return result;
}

std::vector<ParticipantId> Admission::newly_refused(Time now) {
  std::vector<ParticipantId> result = std::exchange(displaced_since_call_, {});
  for (const auto& [id, participant] : participants_) {
    if (now - participant.last_heard > kForgetAfter || check_now(*participant.known, now) != Refusal::kNone)
      result.push_back(id);
  }
  for (const ParticipantId& id : result) participants_.erase(id);
  return result;
}

Admission::Known* Admission::find_known(std::span<const std::uint8_t> der, Time now, Refusal& refusal) {
  std::string bytes(der.begin(), der.end());
  if (const auto found = known_.find(bytes); found != known_.end()) {
    found->second.announced = now;
    return &found->second;
  }
  const auto refuse = [&refusal](Refusal why) -> Known* {
    refusal = why;
    return nullptr;
  };
  if (!checks_.admit(now)) return refuse(Refusal::kTooFast);
  const auto certificate = Certificate::from_der(der);
  if (!certificate) return refuse(Refusal::kNoCertificate);
  if (!certificate->is_issued_by(authority_)) return refuse(Refusal::kOtherAuthority);
  const auto identity = certificate->identity();
  if (!identity) return refuse(Refusal::kUnknownSubject);
  if (known_.size() >= kMaxKnown) forget_oldest();
  if (known_.size() >= kMaxKnown) return refuse(Refusal::kTooMany);
  Known found{*identity,
              *certificate,
              certificate->serial(),
              certificate->prefix(),
              *identity == self_ || exchange_messages(*identity, self_),
              certificate->not_before(),
              certificate->not_after()};
  found.announced = now;
  return &known_.emplace(std::move(bytes), found).first->second;
}

void Admission::forget_oldest() {
  auto oldest = known_.end();
  for (auto entry = known_.begin(); entry != known_.end(); ++entry) {
    const bool is_older = oldest == known_.end() || entry->second.announced < oldest->second.announced;
    if (is_older && !is_in_use(entry->second)) oldest = entry;
  }
  if (oldest != known_.end()) known_.erase(oldest);
}

bool Admission::is_in_use(const Known& known) const {
  return std::ranges::any_of(participants_, [&](const auto& p) { return p.second.known == &known; });
}

Admission::Refusal Admission::check_now(const Known& known, Time now) const {
  if (revoked_.count(known.serial) > 0) return Refusal::kRevoked;
  return now < known.not_before || now > known.not_after ? Refusal::kNotValidNow : Refusal::kNone;
}

std::string Admission::describe(const Decision& decision, const std::string& address) {
  const bool is_impostor =
      decision.refusal == Refusal::kOtherPrefix || decision.refusal == Refusal::kOtherSignature;
  const std::string who = decision.who.empty() || is_impostor ? "a process" : decision.who;
  return who + " at " + address +
         (is_impostor ? " that announces the certificate of " + decision.who : reason_text(decision.refusal));
}

}  // namespace sidestep
