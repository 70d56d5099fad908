// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/negotiation_codec.hpp"

#include <algorithm>

#include "common/messaging/enumerator.hpp"
#include "common/messaging/observation_codec.hpp"
#include "common/messaging/version_codec.hpp"
#include "common/protocol/senders.hpp"

namespace sidestep {
namespace {

/// Whether the sender is an agent of the robot that the message speaks for.
template <typename Message>
bool is_from_own_agent(const Message& message) {
  return message.robot() < kMaxRobots && message.header().sender() == message.robot();
}

template <typename Message>
bool is_plausible(const Message& message, Time now) {
  return sidestep::is_plausible(message.header().incarnation(), now) &&
         sidestep::is_plausible(message.epoch(), now);
}

bool is_checked(const msg::RobotNotice& notice, Time now) {
  return is_uncontrolled(notice) ? decode(notice, now).has_value() : notice.robot() < kMaxRobots;
}

std::optional<VersionSet> decode_versions(const msg::Registration& message, Time now) {
  if (message.is_absent() != (message.version_count() == 0)) return std::nullopt;
  if (message.version_count() > VersionSet::kCapacity) return std::nullopt;
  VersionSet versions;
  for (std::size_t i = 0; i < message.version_count(); ++i) {
    const auto version = decode(message.versions()[i], now);
    if (!version || version->robot != message.robot() || versions.find(version->number)) return std::nullopt;
    versions.add(*version);
  }
  return versions;
}

}  // namespace

std::optional<Proposal> decode(const msg::Proposal& message, Time now) {
  if (!is_from_own_agent(message) || !is_plausible(message, now)) return std::nullopt;
  const msg::Version& first = message.candidates().front();
  Proposal proposal{message.robot(), message.header().incarnation(), message.epoch(),
                    time_from_ns(message.header().stamp_ns()), first.version_number()};
  if (message.candidate_count() > msg::MAX_CANDIDATES) return proposal;
  proposal.candidate_count = message.candidate_count();
  for (std::size_t i = 0; i < proposal.candidate_count; ++i) {
    const msg::Version& candidate = message.candidates()[i];
    if (candidate.robot() == proposal.robot && candidate.base() == first.base() &&
        candidate.start_ns() == first.start_ns())
      proposal.candidates[i] = decode(candidate, now);
  }
  return proposal;
}

std::optional<Registration> decode(const msg::Registration& message, Time now) {
  if (!is_from_own_agent(message) || !is_plausible(message, now)) return std::nullopt;
  return Registration{message.robot(),
                      message.header().incarnation(),
                      message.epoch(),
                      time_from_ns(message.header().stamp_ns()),
                      decode_versions(message, now),
                      message.has_moved(),
                      message.knows_orders(),
                      !message.is_absent() && message.version_count() == 0};
}

std::optional<Verdict> decode(const msg::Verdict& message, RobotId robot) {
  const auto is_known = [](msg::Reason reason) { return is_enumerator(reason, msg::Reason::REASON_HELD); };
  const bool is_valid = message.robot() == robot && is_coordinator(message.header().sender()) &&
                        std::ranges::all_of(message.reasons(), is_known);
  if (!is_valid) return std::nullopt;
  Verdict verdict;
  verdict.sender = message.header().sender();
  verdict.incarnation = message.header().incarnation();
  verdict.robot = robot;
  verdict.epoch = message.epoch();
  verdict.sent_at = time_from_ns(message.header().stamp_ns());
  verdict.proposal_number = message.proposal_number();
  verdict.request_sent_at = time_from_ns(message.request_stamp_ns());
  verdict.granted_version = message.granted_version();
  verdict.reasons = message.reasons();
  verdict.blockers = message.blockers();
  return verdict;
}

std::optional<CoordinatorHeartbeat> decode(const msg::CoordinatorState& message, Time now) {
  const bool is_valid =
      message.coordinator() < kMaxCoordinators &&
      message.header().sender() == static_cast<std::uint32_t>(Sender::kCoordinator) + message.coordinator() &&
      is_plausible(message, now) &&
      is_enumerator(message.coordinator_mode(), msg::CoordinatorMode::COORDINATOR_GRANTING) &&
      decode_role_cause(message) && sidestep::is_plausible(time_from_ns(message.watched_until_ns()), now) &&
      std::ranges::all_of(message.notices(), [=](const auto& notice) { return is_checked(notice, now); });
  if (!is_valid) return std::nullopt;
  return CoordinatorHeartbeat{
      message.header().sender(),  message.header().incarnation(),           message.epoch(),
      message.coordinator_mode(), time_from_ns(message.watched_until_ns()), message.remembers_orders(),
      message.notices()};
}

std::optional<RoleCause> decode_role_cause(const msg::CoordinatorState& message) {
  if (!is_enumerator(message.role_reason(), msg::RoleReason::ROLE_SHARED_EPOCH) ||
      message.role_peer() >= kMaxRobots || message.role_silence_ns() < 0)
    return std::nullopt;
  return RoleCause{message.role_reason(), message.role_peer(), Duration{message.role_silence_ns()},
                   message.role_learned_epoch()};
}

void encode(const RoleCause& cause, msg::CoordinatorState& message) {
  message.role_reason(cause.reason);
  message.role_peer(cause.peer);
  message.role_silence_ns(cause.silence.count());
  message.role_learned_epoch(cause.learned);
}

msg::Proposal encode(const Proposal& proposal) {
  msg::Proposal message;
  message.robot(proposal.robot);
  message.header().sender(proposal.robot);
  message.header().incarnation(proposal.incarnation);
  message.epoch(proposal.epoch);
  message.candidate_count(static_cast<std::uint8_t>(proposal.candidate_count));
  for (std::size_t i = 0; i < proposal.candidate_count; ++i) {
    if (proposal.candidates[i]) message.candidates()[i] = encode(*proposal.candidates[i]);
  }
  return message;
}

msg::Registration encode(const Registration& registration) {
  msg::Registration message;
  message.robot(registration.robot);
  message.header().sender(registration.robot);
  message.header().incarnation(registration.incarnation);
  message.epoch(registration.epoch);
  const VersionSet versions = registration.versions.value_or(VersionSet{});
  message.is_absent(registration.versions && versions.versions().empty());
  message.has_moved(registration.has_moved);
  message.knows_orders(registration.knows_orders);
  message.version_count(static_cast<std::uint8_t>(versions.versions().size()));
  std::ranges::transform(versions.versions(), message.versions().begin(),
                         [](const Version& version) { return encode(version); });
  return message;
}

msg::Verdict encode(const Verdict& verdict) {
  msg::Verdict message;
  message.robot(verdict.robot);
  message.epoch(verdict.epoch);
  message.proposal_number(verdict.proposal_number);
  message.request_stamp_ns(to_ns(verdict.request_sent_at));
  message.granted_version(verdict.granted_version);
  message.reasons() = verdict.reasons;
  message.blockers() = verdict.blockers;
  return message;
}

}  // namespace sidestep
