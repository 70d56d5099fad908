// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deploy/audit/audited_run.hpp"
#include "deploy/audit/comparable_stamps.hpp"
#include "deploy/inspect/senders/message_trace.hpp"

namespace sidestep {

/// Infers from message headers when and in which order messages were sent, and how many were missed.
class MessageTimes {
 public:
  /// Topics whose messages each sender numbers separately.
  enum Kind : std::uint8_t {
    kProposalKind,
    kVerdictKind,
    kRegistrationKind,
    kCoordinatorKind,
    kLedgerKind,
    kCommandKind,
    kRobotReportKind,
    kTruthKind,
    kWorldKind,
    kOrderAnswerKind,
    kOrderMemoryKind,
    kOrderStatusKind
  };
  static bool is_agent_kind(Kind kind) {
    return kind == kProposalKind || kind == kRegistrationKind || kind == kCommandKind;
  }

  explicit MessageTimes(const AuditedRun& run)
      : run_(run), trace_(run.latency_bound()), agent_trace_(run.latency_bound()) {}

  Reception record(Kind kind, std::uint32_t key, const msg::Header& header, Time now) {
    record_stamp(kind, key, header);
    return (is_agent_kind(kind) ? agent_trace_ : trace_).record(channel_of(kind, key), header, now);
  }
  /// Records the stamp of a message that may be missed without harm.
  void record_stamp(Kind kind, std::uint32_t key, const msg::Header& header) {
    stamps_.record(channel_of(kind, key), header);
  }

  /// Whether sending times of this agent or coordinator can be compared. Times by the auditor's clock always
  /// can; times by the sender's clock can only until that clock is set back.
  bool are_comparable(const msg::Header& header) const {
    return run_.is_complete() || stamps_.are_in_order(header.sender(), header.incarnation());
  }
  /// An upper bound of the time at which a coordinator sent a message: by the auditor's clock if the auditor
  /// receives every message, otherwise by the coordinator's clock, which orders its messages exactly.
  std::int64_t granter_time_ns(const msg::Header& header, const Reception& reception) const {
    return run_.is_complete() ? reception.latest_ns : header.stamp_ns();
  }

  const ComparableStamps& stamps() const { return stamps_; }  ///< stamps of agents and coordinators
  const MessageTrace& trace() const { return trace_; }        ///< trace of all senders except agents
  const MessageTrace& agent_trace() const { return agent_trace_; }

 private:
  static constexpr std::uint64_t channel_of(Kind kind, std::uint32_t key) {
    return static_cast<std::uint64_t>(kind) << 32 | key;
  }

  const AuditedRun& run_;
  ComparableStamps stamps_;
  MessageTrace trace_, agent_trace_;
};

}  // namespace sidestep
