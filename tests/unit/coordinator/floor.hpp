// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/messaging/version_codec.hpp"
#include "common/motion/validity.hpp"
#include "common/random/rng.hpp"
#include "idl/negotiation.hpp"
#include "idl/robot.hpp"

namespace sidestep {

/// Versions and messages for tests of the ledger and the coordinator. Times are in seconds. The floor is
/// empty.
inline Time at_s(double seconds) { return from_seconds(seconds) + Time{}; }

inline FloorRules floor_for_tests() {
  FloorRules rules;
  rules.field = {20, 20};
  return rules;
}

inline Version rest_version(RobotId robot, Vec2 position, VersionNumber number = 0) {
  return {robot, 0, number, 0, Trajectory::resting(at_s(0), position)};
}

/// A version that continues `base` from start_s with an acceleration for `seconds`, then stops.
inline Version continued(const Version& base, VersionNumber number, double start_s, Vec2 acceleration,
                         double seconds = 1.0 / 60) {
  Trajectory trajectory(at_s(start_s), base.trajectory.state_at(at_s(start_s)));
  trajectory.append(from_seconds(seconds), acceleration);
  append_stop(trajectory, 5);
  return {base.robot, 1, number, base.number, trajectory};
}

inline msg::Registration registration_of(const Version& version, Epoch epoch, Incarnation incarnation = 1) {
  msg::Registration registration;
  registration.robot(version.robot);
  registration.header().sender(version.robot);
  registration.header().incarnation(incarnation);
  registration.epoch(epoch);
  registration.version_count(1);
  registration.versions()[0] = encode(version);
  return registration;
}

inline msg::Proposal proposal_of(const std::vector<Version>& candidates, Epoch epoch,
                                 Incarnation incarnation = 1) {
  msg::Proposal proposal;
  proposal.robot(candidates.front().robot);
  proposal.header().sender(candidates.front().robot);
  proposal.header().incarnation(incarnation);
  proposal.epoch(epoch);
  proposal.candidate_count(static_cast<std::uint8_t>(candidates.size()));
  for (std::size_t i = 0; i < candidates.size(); ++i) proposal.candidates()[i] = encode(candidates[i]);
  return proposal;
}

inline msg::Feedback make_report(const Version& executing, double at) {
  msg::Feedback robot_report;
  robot_report.robot(executing.robot);
  robot_report.header().sender(executing.robot);
  robot_report.valid_at_ns(to_ns(at_s(at)));
  robot_report.obeyed_incarnation(1);
  robot_report.executing(encode(executing));
  return robot_report;
}

}  // namespace sidestep
