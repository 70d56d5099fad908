// SPDX-License-Identifier: Apache-2.0
// Random decoded messages of robot 3, and their encoded forms as Writer::publish() sends them.
#pragma once

#include "common/messaging/course_codec.hpp"
#include "common/messaging/negotiation_codec.hpp"
#include "common/messaging/robot_codec.hpp"
#include "common/protocol/senders.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

namespace sidestep::random_messages {

inline constexpr RobotId kRobot = 3;

/// The receiver's clock.
inline constexpr Time kNow = time_from_ns(1'800'000'000'000'000'000);

/// A random incarnation, epoch or version number that a message may contain at kNow.
inline std::uint64_t random_number(Rng& rng) {
  return rng.below(static_cast<std::uint64_t>(to_ns(kNow + std::chrono::hours(1))));
}
/// A random time that a message may contain at kNow.
inline Time random_time(Rng& rng) { return time_from_ns(static_cast<std::int64_t>(random_number(rng))); }

inline Version random_version(Rng& rng) {
  Version version{kRobot,
                  random_number(rng),
                  random_number(rng),
                  random_number(rng),
                  random_trajectory(rng),
                  rng.uniform(0, 0.1)};
  // Intents have single precision in messages.
  const auto single = [&](double max) {
    return static_cast<double>(static_cast<float>(rng.uniform(0, max)));
  };
  if (rng.chance(0.5))
    version.intent = {{single(3), single(3)},
                      single(1),
                      {single(9), single(9)},
                      {single(9), single(9)},
                      {single(9), single(9)}};
  return version;
}

/// Numbers have single precision, as in messages. Precondition: points > 0.
inline DrivingCourse random_course(Rng& rng, std::size_t points) {
  const auto single = [&](double max) {
    return static_cast<double>(static_cast<float>(rng.uniform(-max, max)));
  };
  DrivingCourse course;
  course.robot = kRobot;
  course.planned_at = std::max(random_time(rng), time_from_ns(1));
  course.due = random_time(rng);
  course.start = kNow + from_seconds(rng.uniform(-59, 4.9));
  for (std::size_t i = 0; i < points; ++i)
    course.states.push_back({{single(1.5), single(1.5)}, {single(3), single(3)}});
  course.states.back().velocity_mps = {0, 0};
  course.continues = rng.chance(0.5);
  return course;
}

inline Command random_command(Rng& rng) {
  Command command{kRobot, 1 + rng.below(1'000'000), random_number(rng), random_time(rng)};
  if (rng.chance(0.7)) {
    command.version = random_version(rng);
    command.version->incarnation = rng.below(command.incarnation + 1);
    command.version->number = 1 + random_number(rng) / 2;
  }
  if (rng.chance(0.7)) command.fix = PoseFix{random_time(rng), random_vector(rng, 20), rng.uniform(-4, 4)};
  command.desired_heading_rad = rng.uniform(-4, 4);
  return command;
}

inline RobotReport random_robot_report(Rng& rng) {
  RobotReport robot_report;
  robot_report.robot = kRobot;
  robot_report.robot_incarnation = random_number(rng);
  robot_report.obeyed_incarnation = random_number(rng);
  robot_report.obeyed_epoch = random_number(rng);
  robot_report.valid_at = random_time(rng);
  robot_report.executing = random_version(rng);
  robot_report.is_off_reference = rng.chance(0.5);
  robot_report.is_lifted = rng.chance(0.5);
  if (rng.chance(0.7)) robot_report.command = {random_time(rng), random_time(rng)};
  robot_report.estimate = {random_vector(rng, 20), random_vector(rng, 4)};
  robot_report.heading_rad = rng.uniform(-4, 4);
  robot_report.tracking_error_m = rng.uniform(0, 1);
  robot_report.uncertainty = {rng.uniform(0, 0.1), rng.uniform(0, 0.1)};
  robot_report.has_moved = rng.chance(0.5);
  robot_report.activated = rng.bits();
  robot_report.lead = Duration{static_cast<std::int64_t>(rng.uniform(0.0, 3e8))};
  return robot_report;
}

inline Proposal random_proposal(Rng& rng) {
  Proposal proposal{kRobot, random_number(rng), random_number(rng), random_time(rng), random_number(rng) / 2};
  proposal.candidate_count = 1 + rng.below(msg::MAX_CANDIDATES);
  const Version first = random_version(rng);
  for (std::size_t i = 0; i < proposal.candidate_count; ++i) {
    Version& candidate = proposal.candidates[i].emplace(first);
    candidate.number = proposal.number + i;
    candidate.trajectory =
        Trajectory(first.trajectory.start(), {random_vector(rng, 1), random_vector(rng, 2)});
    append_stop(candidate.trajectory, 5);
  }
  return proposal;
}

inline Registration random_registration(Rng& rng) {
  Registration registration{kRobot, random_number(rng), random_number(rng), random_time(rng), VersionSet()};
  for (std::uint64_t count = rng.below(VersionSet::kCapacity + 1); count > 0; --count)
    registration.versions->add(random_version(rng));
  return registration;
}

inline Verdict random_verdict(Rng& rng) {
  Verdict verdict{static_cast<std::uint32_t>(Sender::kCoordinator),
                  random_number(rng),
                  kRobot,
                  random_number(rng),
                  random_time(rng),
                  rng.bits(),
                  random_time(rng),
                  rng.bits()};
  for (msg::Reason& reason : verdict.reasons)
    reason = static_cast<msg::Reason>(rng.below(static_cast<std::uint32_t>(msg::Reason::REASON_HELD) + 1));
  for (RobotId& blocker : verdict.blockers) blocker = static_cast<RobotId>(rng.bits());
  return verdict;
}

/// The message for a value, with the value's sending time in its header.
template <typename Value>
auto message_of(const Value& value) {
  auto message = encode(value);
  message.header().stamp_ns(to_ns(value.sent_at));
  return message;
}
inline msg::Verdict message_of(const Verdict& verdict) {
  msg::Verdict message = encode(verdict);
  message.header().sender(verdict.sender);
  message.header().incarnation(verdict.incarnation);
  message.header().stamp_ns(to_ns(verdict.sent_at));
  return message;
}
inline msg::Feedback message_of(const RobotReport& robot_report) { return encode(robot_report); }

}  // namespace sidestep::random_messages
