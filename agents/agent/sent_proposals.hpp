// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "agents/agent/held_versions.hpp"
#include "common/protocol/negotiation_messages.hpp"

namespace sidestep {

/// One proposal of the agent, with its candidates in order of preference.
struct SentProposal {
  std::array<Version, msg::MAX_CANDIDATES> candidates;
  std::size_t count = 0;
  Time proposed_at{};
  int lead = 1;
  bool is_answered = true;
  bool is_open = false;  ///< a grant would still be forwarded

  VersionNumber number() const { return candidates.front().number; }
  Time start() const { return candidates.front().trajectory.start(); }
  /// The candidate with this number; nullptr if there is none.
  const Version* find(VersionNumber number) const;
};

/// The agent's latest proposals for which verdicts may still arrive.
class SentProposals {
 public:
  /// Adds a proposal for this start. The caller fills in the candidates.
  SentProposal& add(Time start, Time now, int lead);

  /// The proposal with this number that has not been answered yet; nullptr if there is none.
  SentProposal* find_unanswered(VersionNumber number);
  /// Number of consecutive proposals, up to the latest, that have the same start.
  int attempts() const { return attempts_; }
  /// The start of the latest proposal if its verdict is overdue and there is time to propose it again.
  std::optional<Time> start_to_retry(Time now, Duration answer_timeout, Duration cycle) const;
  /// Whether a proposal that starts soon after `now` awaits its verdict.
  bool has_upcoming(Time now) const;

  /// Closes all proposals: grants of them are no longer forwarded.
  void close();
  /// Closes the proposals that continue a version to which the robot can no longer switch. Returns whether it
  /// closed any.
  bool close_unreachable(const HeldVersions& held);
  /// Closes the proposals whose start has passed, because their verdicts would arrive too late. Returns the
  /// lead, in cycles, of the last proposal that it closed; 0 if it closed none.
  int close_started(Time now);
  /// Forgets all proposals. Later verdicts on them count as unexpected.
  void discard();

 private:
  /// The latest proposal; nullptr before the first.
  const SentProposal* newest() const;

  std::array<SentProposal, 8> proposals_;
  std::size_t count_ = 0;
  int attempts_ = 0;
};

}  // namespace sidestep
