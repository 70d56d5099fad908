// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "agents/agent/negotiation.hpp"
#include "tests/catch.hpp"

namespace sidestep::negotiation_fixture {

inline constexpr RobotId kRobot = 3;
inline constexpr Incarnation kSelf = 1000;
inline constexpr Epoch kEpoch = 50;

inline Time at_s(double seconds) { return Time{} + from_seconds(seconds); }

inline RobotReport make_report(const Version& executing, double at, Incarnation obeyed = kSelf,
                               Epoch epoch = kEpoch) {
  RobotReport robot_report;
  robot_report.robot = kRobot;
  robot_report.valid_at = at_s(at);
  robot_report.obeyed_incarnation = obeyed;
  robot_report.obeyed_epoch = epoch;
  robot_report.executing = executing;
  return robot_report;
}

/// A heartbeat, which is valid until the next call.
inline CoordinatorHeartbeat heartbeat(Epoch epoch, const std::vector<RobotId>& missing = {}) {
  static std::vector<msg::RobotNotice> notices;
  notices.assign(missing.size(), {});
  for (std::size_t i = 0; i < missing.size(); ++i) {
    notices[i].robot(missing[i]);
    notices[i].is_missing(true);
  }
  CoordinatorHeartbeat state;
  state.epoch = epoch;
  state.mode = missing.empty() ? msg::CoordinatorMode::COORDINATOR_GRANTING
                               : msg::CoordinatorMode::COORDINATOR_REGISTERING;
  state.notices = notices;
  return state;
}

/// The coordinator's answer to a proposal. It grants nothing.
inline Verdict verdict_on(const Proposal& proposal, Epoch epoch = kEpoch) {
  Verdict verdict;
  verdict.robot = kRobot;
  verdict.epoch = epoch;
  verdict.proposal_number = proposal.number;
  return verdict;
}

/// One agent's negotiation, with the messages that its robot and the coordinator send.
struct NegotiationFixture {
  Negotiation n{kRobot, kSelf, from_seconds(1.0 / 60)};
  Version initial{kRobot, 0, 0, 0, Trajectory::resting(at_s(0), {0, 0})};

  void become_ready() {
    n.on_robot_report(make_report(initial, 0.5));
    n.on_coordinator_state(heartbeat(kEpoch), at_s(0.9));
    (void)n.registration();
    REQUIRE(n.may_propose(at_s(0.95)));
  }
  Proposal propose(double start, double now) {
    const Version& base = n.held().base_at(at_s(start));
    Trajectory trajectory(at_s(start), base.trajectory.state_at(at_s(start)));
    trajectory.append(from_seconds(0.1), {1, 0});
    append_stop(trajectory, 5);
    return n.propose({&trajectory, 1}, base.number, at_s(now));
  }
  /// Grants the first candidate. Returns the version to forward; nullopt if the verdict is not obeyed.
  std::optional<Version> grant(const Proposal& proposal, double now, Epoch epoch = kEpoch) {
    Verdict verdict = verdict_on(proposal, epoch);
    verdict.granted_version = proposal.candidates[0]->number;
    return n.on_verdict(verdict, at_s(now)).granted;
  }
};

}  // namespace sidestep::negotiation_fixture
