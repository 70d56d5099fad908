// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/epoch_audit.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "common/messaging/robot_notices.hpp"

namespace sidestep {
namespace {

constexpr std::size_t kMaxEpochs = 64, kMaxStreams = 8;

}  // namespace

EpochAudit::EpochRecord& EpochAudit::epoch_record(Epoch epoch) {
  const auto entry = epochs_.try_emplace(epoch).first;
  if (epochs_.size() > kMaxEpochs)
    epochs_.erase(entry == epochs_.begin() ? std::next(entry) : epochs_.begin());
  return entry->second;
}

void EpochAudit::on_registration(AuditedRobot& robot, const msg::Registration& registration,
                                 const Reception& reception) {
  const Epoch epoch = registration.epoch();
  AuditedRobot::Registered registered;
  registered.epoch = epoch;
  registered.incarnation = registration.header().incarnation();
  registered.earliest_ns = reception.earliest_ns;
  registered.latest_ns = reception.latest_ns;
  registered.stamp_ns = registration.header().stamp_ns();
  registered.is_absent = registration.is_absent();
  for (std::size_t i = 0; i < registration.version_count(); ++i) {
    KnownVersion* known = robots_.store(robot, registration.versions()[i]);
    if (!known) return;
    registered.versions.push_back(known->number);
    known->registered_in.add(epoch);
  }
  robot.registered_in.add(epoch);
  // The attestation stays valid in the epochs that had begun when it was given.
  robot.attested_until = std::min(robot.attested_until, std::max(epoch, robot.attested_in));
  if (!robot.registered || epoch >= robot.registered->epoch) robot.registered = std::move(registered);
}

void EpochAudit::on_attestation(AuditedRobot& robot) const {
  robot.attested_until = std::numeric_limits<Epoch>::max();
  robot.attested_in = newest_epoch_;
}

void EpochAudit::on_coordinator(const msg::CoordinatorState& state, const Reception& reception) {
  newest_epoch_ = std::max(newest_epoch_, state.epoch());
  const auto known = epochs_.find(state.epoch());
  if (known == epochs_.end() || known->second.is_reported) return;
  const std::vector<RobotId> missing = missing_robots(state);
  if (missing.empty()) return;
  const std::int64_t sent_ns = run_.is_complete() ? reception.earliest_ns : state.header().stamp_ns();
  if (known->second.granter_incarnation != state.header().incarnation() ||
      sent_ns <= known->second.first_grant_ns || !times_.are_comparable(state.header()))
    return;
  known->second.is_reported = true;
  findings_.report(AuditRule::kAllRegistered, missing.front(), nullptr, state.epoch(),
                   "the coordinator has granted, although {} robots have not registered", missing.size());
}

void EpochAudit::on_command(const AuditedRobot& robot, const msg::Command& command,
                            const Reception& reception) {
  auto& streams = streams_[robot.id];
  auto stream = std::ranges::find(streams, command.header().incarnation(), &AgentStream::incarnation);
  if (stream == streams.end()) {
    if (streams.size() >= kMaxStreams) streams.erase(streams.begin());
    stream = streams.insert(streams.end(), {command.header().incarnation(), command.epoch()});
  }
  if (reception.is_newest && command.epoch() < stream->epoch) {
    findings_.report(AuditRule::kEpochRegression, robot.id, nullptr, command.epoch(),
                     "the agent's previous command was under epoch {}", stream->epoch);
  }
  if (reception.is_newest) stream->epoch = std::max(stream->epoch, command.epoch());
}

void EpochAudit::on_grant(const AuditedRobot& robot, const KnownVersion& known, const msg::Verdict& verdict) {
  EpochRecord& record = epoch_record(verdict.epoch());
  const Incarnation incarnation = verdict.header().incarnation();
  if (record.first_grant_ns == kNever) {
    record.granter = verdict.header().sender();
    record.granter_incarnation = incarnation;
    for (const AuditedRobot& other : robots_.all()) {
      if (!run_.is_complete() || other.registered_in.may_have_held(verdict.epoch()) ||
          verdict.epoch() <= other.attested_until)
        continue;
      record.is_reported = true;
      findings_.report(AuditRule::kAllRegistered, other.id, nullptr, verdict.epoch(),
                       "had not registered when version {} of robot {} was granted", known.number, robot.id);
    }
  } else if (record.granter_incarnation != incarnation || record.granter != verdict.header().sender()) {
    findings_.report(AuditRule::kSingleCoordinator, robot.id, &known, verdict.epoch(),
                     "coordinator {} (incarnation {}) grants after coordinator {} (incarnation {})",
                     verdict.header().sender(), incarnation, record.granter, record.granter_incarnation);
  }
  record.first_grant_ns = std::min(record.first_grant_ns, known.granted_by_ns);
}

void EpochAudit::check_obeyed(AuditedRobot& robot, const KnownVersion& executing,
                              const msg::Feedback& feedback, const Reception& reception) {
  const bool is_switch = robot.last_report && robot.last_report->executing != executing.number;
  if (is_switch && executing.sent_ns != kNever && run_.is_complete() &&
      executing.sent_ns > robot.last_report->epoch_since_ns &&
      executing.sent_epoch < robot.last_report->obeyed_epoch) {
    findings_.report(AuditRule::kStaleEpoch, robot.id, &executing, executing.sent_epoch,
                     "was sent after the robot had obeyed epoch {}", robot.last_report->obeyed_epoch);
  }
  // A robot that executes a version of an epoch obeys that epoch, and its agent has registered in it.
  if (!run_.is_complete() && executing.granted_in > feedback.obeyed_epoch() && executing.is_proposed &&
      !executing.is_own_stop && !epoch_record(executing.granted_in).is_reported) {
    epoch_record(executing.granted_in).is_reported = true;
    findings_.report(AuditRule::kAllRegistered, robot.id, &executing, executing.granted_in,
                     "still obeys epoch {}, so it cannot have registered before the grant",
                     feedback.obeyed_epoch());
  }
  // If messages may be missed, the order of reports and grants is unknown, and so are attestations of
  // absence.
  for (auto& [epoch, record] : epochs_) {
    if (!run_.is_complete()) break;
    if (record.is_reported || feedback.is_lifted() || feedback.obeyed_epoch() >= epoch) continue;
    if (record.first_grant_ns >= reception.earliest_ns) continue;
    if (epoch <= std::max(robot.attested_until, robot.forgotten_until_epoch)) continue;
    record.is_reported = true;
    findings_.report(AuditRule::kAllRegistered, robot.id, nullptr, epoch,
                     "still obeys epoch {}, so it cannot have registered before the first grant",
                     feedback.obeyed_epoch());
  }
  if (robot.registered && !robot.registered->is_reported && is_after_registration(robot, feedback, reception))
    check_registration(robot, executing, feedback);
}

bool EpochAudit::is_after_registration(const AuditedRobot& robot, const msg::Feedback& feedback,
                                       const Reception& reception) const {
  const AuditedRobot::Registered& registered = *robot.registered;
  if (run_.is_complete()) return registered.latest_ns < reception.earliest_ns;
  // The report repeats the stamp of a command that the agent sent after the registration.
  return feedback.obeyed_incarnation() == registered.incarnation &&
         times_.stamps().are_in_order(robot.id, registered.incarnation) &&
         feedback.command_stamp_ns() > registered.stamp_ns;
}

void EpochAudit::check_registration(AuditedRobot& robot, const KnownVersion& executing,
                                    const msg::Feedback& feedback) {
  AuditedRobot::Registered& registered = *robot.registered;
  if (feedback.obeyed_epoch() < registered.epoch || feedback.obeyed_incarnation() < registered.incarnation) {
    registered.is_reported = true;
    findings_.report(AuditRule::kAcknowledged, robot.id, nullptr, registered.epoch,
                     "incarnation {} registered, but the robot later obeys incarnation {} and epoch {}",
                     registered.incarnation, feedback.obeyed_incarnation(), feedback.obeyed_epoch());
    return;
  }
  const bool is_known_older =
      executing.number == 0 || (executing.granted_in != 0 && executing.granted_in < registered.epoch);
  const bool is_registered =
      std::ranges::find(registered.versions, executing.number) != registered.versions.end();
  if (!is_known_older || is_registered || executing.is_own_stop || feedback.is_lifted()) return;
  registered.is_reported = true;
  findings_.report(AuditRule::kRegistration, robot.id, &executing, registered.epoch,
                   "is being executed after the registration, which does not contain it; granted in epoch {}",
                   executing.granted_in);
}

bool EpochAudit::is_from_granter(const msg::LedgerPage& page) const {
  const auto record = epochs_.find(page.epoch());
  return record == epochs_.end() || record->second.first_grant_ns == kNever ||
         record->second.granter_incarnation == page.header().incarnation();
}

bool EpochAudit::is_from_first_sender(const msg::LedgerPage& page) {
  EpochRecord& record = epoch_record(page.epoch());
  const Incarnation incarnation = page.header().incarnation();
  if (record.page_incarnation == 0) record.page_incarnation = incarnation;
  return record.page_incarnation == incarnation && is_from_granter(page);
}

}  // namespace sidestep
