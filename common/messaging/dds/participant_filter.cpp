// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/participant_filter.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/log/log.hpp"
#include "common/messaging/dds/datagram.hpp"
#include "common/messaging/dds/event_loop.hpp"
#include "common/messaging/topic_access.hpp"
#include "common/protocol/process_names.hpp"

namespace sidestep {
namespace {

// Maximum number of refusals reported in a burst, because a hostile sender can cause any number of them.
// Further refusals are reported at a rate of one per period.
constexpr int kMaxReported = 64;
constexpr Duration kReportPeriod = std::chrono::seconds(10);

}  // namespace

ParticipantFilter::ParticipantFilter(const KeyFolder& keys, const std::string& version)
    : revoked_file_(keys.file(key_files::kRevoked)),
      authority_(keys.authority),
      admission_(keys.identity, keys.authority, version),
      reports_(kMaxReported, kReportPeriod) {
  admission_.revoke(load_revoked_serials(revoked_file_, authority_));
  std::error_code none;
  revoked_at_ = std::filesystem::last_write_time(revoked_file_, none);
}

bool ParticipantFilter::passes(const ParticipantId& sender, std::span<const std::uint8_t> datagram,
                               bool is_discovery, std::span<const std::uint8_t, 4> address) {
  const Time now = EventLoop::now();
  if (is_discovery) {
    bool is_plain = false;
    const auto announcement = participant_announcement(datagram, is_plain);
    if (!is_plain) {
      ++refused_;
      return false;
    }
    if (announcement && !announcement->is_departure) {
      const std::lock_guard lock(mutex_);
      const Admission::Decision decision = admission_.on_announcement(sender, announcement->user_data, now);
      if (decision.refusal == Admission::Refusal::kNone) return true;
      // Not reported: a participant that is not needed, or one that will be admitted later because too many
      // announce themselves now.
      if (decision.refusal == Admission::Refusal::kNotNeeded ||
          decision.refusal == Admission::Refusal::kTooFast)
        return false;
      ++refused_;
      report("refuses " + Admission::describe(decision, fmt::format("{}", fmt::join(address, "."))));
      return false;
    }
  }
  const std::lock_guard lock(mutex_);
  const bool is_admitted = admission_.admits(sender, now);
  unknown_ += !is_admitted && !is_discovery;
  return is_admitted;
}

void ParticipantFilter::set_self(const ParticipantId& id) {
  const std::lock_guard lock(mutex_);
  admission_.set_self(id);
}

std::vector<ParticipantId> ParticipantFilter::newly_refused() {
  const std::lock_guard lock(mutex_);
  read_revoked();
  const Time now = EventLoop::now();
  for (const Identity& identity : admission_.newly_unauthenticated(now))
    report(fmt::format(
        "refuses a process that announces itself as {}: for {:.0f} s it has not shown a genuine private "
        "key and genuine permissions",
        to_text(identity), to_seconds(Admission::kMaxUnproven)));
  return admission_.newly_refused(now);
}

bool ParticipantFilter::may_send(const ParticipantId& participant, const TopicInfo& topic,
                                 std::uint32_t robot, std::uint32_t sender) {
  const std::lock_guard lock(mutex_);
  const Identity* const identity = admission_.identity_of(participant);
  if (identity && may_write(*identity, topic, robot) && may_use_sender(*identity, sender)) return true;
  ++forged_;
  report(fmt::format("refuses messages of {} on topic '{}' in the name of {}",
                     identity ? to_text(*identity) : "an unknown participant", topic.name,
                     process_name(sender)));
  return false;
}

bool ParticipantFilter::is_operator(const ParticipantId& participant) const {
  const std::lock_guard lock(mutex_);
  const Identity* const identity = admission_.identity_of(participant);
  return identity && identity->role == Role::kOperator;
}

void ParticipantFilter::on_authentication(const ParticipantId& participant, bool is_genuine) {
  const std::lock_guard lock(mutex_);
  if (is_genuine) return admission_.on_authenticated(participant);
  const Identity* const identity = admission_.identity_of(participant);
  report(fmt::format("refuses {}: its private key or certificate is not genuine",
                     identity ? "a process that announces itself as " + to_text(*identity) : "a process"));
}

void ParticipantFilter::read_revoked() {
  std::error_code error;
  const auto changed_at = std::filesystem::last_write_time(revoked_file_, error);
  if (error || changed_at == revoked_at_) return;
  revoked_at_ = changed_at;
  try {
    const std::set<std::string> listed = load_revoked_serials(revoked_file_, authority_);
    if (!std::ranges::includes(listed, admission_.revoked()))
      log(LogLevel::kWarning,
          fmt::format("keys: {} no longer lists some revoked keys; they stay revoked", revoked_file_));
    admission_.revoke(listed);
    log(LogLevel::kInfo, "reloaded the list of revoked keys");
  } catch (const std::invalid_argument& problem) {
    log(LogLevel::kError, fmt::format("{}; the previous list remains in force", problem.what()));
  }
}

void ParticipantFilter::report(const std::string& text) {
  if (reported_.contains(text) || !reports_.admit(EventLoop::now())) return;
  if (reported_.size() >= kMaxReported) reported_.clear();
  reported_.insert(text);
  log(LogLevel::kWarning, "keys: " + text);
}

}  // namespace sidestep
