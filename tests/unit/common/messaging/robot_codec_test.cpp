// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/robot_codec.hpp"

#include <limits>

#include "tests/catch.hpp"
#include "tests/unit/common/messaging/random_messages.hpp"
#include "tests/unit/common/messaging/same_version.hpp"

namespace sidestep::robot_codec_test {

using namespace random_messages;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::int64_t kHostileTimes_ns[] = {to_ns(kNow + std::chrono::hours(1)), -1, to_ns(kMaxTime) + 1,
                                             to_ns(Time::max()), to_ns(Time::min())};
/// Values that are invalid as an incarnation, epoch or version number.
constexpr std::uint64_t kHostileNumbers[] = {static_cast<std::uint64_t>(to_ns(kNow + std::chrono::hours(1))),
                                             std::uint64_t{1} << 62, std::uint64_t{1} << 63,
                                             std::numeric_limits<std::uint64_t>::max()};

/// A command with all optional parts.
msg::Command full_command() {
  Command command{kRobot, 1000, 7, time_from_ns(5)};
  command.version = Version{kRobot, 1000, 20, 0, Trajectory::resting(Time{}, {1, 2})};
  command.fix = PoseFix{Time{}, {1, 2}, 0.5};
  return message_of(command);
}

/// A report with all optional parts.
msg::Feedback full_robot_report() {
  RobotReport robot_report;
  robot_report.robot = robot_report.executing.robot = kRobot;
  robot_report.command = {time_from_ns(1), time_from_ns(2)};
  return encode(robot_report);
}

TEST_CASE("a command survives encoding and decoding bit for bit") {
  const std::uint64_t seed = GENERATE(1u, 2u);
  CAPTURE(seed);
  Rng rng(seed);
  for (int i = 0; i < 5000; ++i) {
    const Command in = random_command(rng);
    const msg::Command message = message_of(in);
    REQUIRE(message.header().sender() == kRobot);
    const auto out = decode(message, kRobot, kNow);
    REQUIRE(out);
    REQUIRE(out->robot == in.robot);
    REQUIRE(out->incarnation == in.incarnation);
    REQUIRE(out->epoch == in.epoch);
    REQUIRE(out->sent_at == in.sent_at);
    REQUIRE(out->version.has_value() == in.version.has_value());
    if (in.version) REQUIRE(is_same(*out->version, *in.version));
    REQUIRE(out->fix.has_value() == in.fix.has_value());
    if (in.fix) {
      REQUIRE(out->fix->captured_at == in.fix->captured_at);
      REQUIRE(out->fix->position_m == in.fix->position_m);
      REQUIRE(out->fix->heading_rad == in.fix->heading_rad);
    }
    REQUIRE(out->desired_heading_rad == in.desired_heading_rad);
  }
}

TEST_CASE("feedback survives encoding and decoding bit for bit") {
  const std::uint64_t seed = GENERATE(1u, 2u);
  CAPTURE(seed);
  Rng rng(seed);
  for (int i = 0; i < 5000; ++i) {
    const RobotReport in = random_robot_report(rng);
    const auto out = decode(encode(in), kRobot, kNow);
    REQUIRE(out);
    REQUIRE(out->robot == in.robot);
    REQUIRE(out->robot_incarnation == in.robot_incarnation);
    REQUIRE(out->obeyed_incarnation == in.obeyed_incarnation);
    REQUIRE(out->obeyed_epoch == in.obeyed_epoch);
    REQUIRE(out->valid_at == in.valid_at);
    REQUIRE(is_same(out->executing, in.executing));
    REQUIRE(out->is_off_reference == in.is_off_reference);
    REQUIRE(out->is_lifted == in.is_lifted);
    REQUIRE(out->is_absent() == in.is_absent());
    REQUIRE(out->command.has_value() == in.command.has_value());
    if (in.command) {
      REQUIRE(out->command->sent_at == in.command->sent_at);
      REQUIRE(out->command->received_at == in.command->received_at);
    }
    REQUIRE(out->estimate.position_m == in.estimate.position_m);
    REQUIRE(out->estimate.velocity_mps == in.estimate.velocity_mps);
    REQUIRE(out->heading_rad == in.heading_rad);
    REQUIRE(out->tracking_error_m == in.tracking_error_m);
    REQUIRE(out->uncertainty.position_error_rms_m == in.uncertainty.position_error_rms_m);
    REQUIRE(out->uncertainty.odometry_scale_stddev == in.uncertainty.odometry_scale_stddev);
    REQUIRE(out->has_moved == in.has_moved);
    REQUIRE(out->activated == in.activated);
    REQUIRE(out->lead == in.lead);
  }
}

TEST_CASE("a command with one invalid field is refused") {
  using Message = msg::Command;
  const auto is_refused = [](auto spoil) {
    Message message = full_command();
    REQUIRE(decode(message, kRobot, kNow));
    spoil(message);
    return !decode(message, kRobot, kNow);
  };
  CHECK(is_refused([](Message& m) { m.robot(kRobot + 1); }));
  CHECK(is_refused([](Message& m) { m.header().sender(kRobot + 1); }));
  CHECK(is_refused([](Message& m) { m.has_version(false), m.header().incarnation(0); }));
  CHECK(is_refused([](Message& m) { m.version().robot(kRobot + 1); }));
  CHECK(is_refused([](Message& m) { m.version().version_number(0); }));
  CHECK(is_refused([](Message& m) { m.version().incarnation(1001); }));
  CHECK(is_refused([](Message& m) { m.version().phase_count(99); }));
  for (const std::uint64_t number : kHostileNumbers) {
    CHECK(is_refused([=](Message& m) { m.header().incarnation(number); }));
    CHECK(is_refused([=](Message& m) { m.epoch(number); }));
    CHECK(is_refused([=](Message& m) { m.version().version_number(number); }));
    CHECK(is_refused([=](Message& m) { m.version().base(number); }));
  }
  for (const std::int64_t ns : kHostileTimes_ns) {
    CHECK(is_refused([=](Message& m) { m.header().stamp_ns(ns); }));
    CHECK(is_refused([=](Message& m) { m.version().start_ns(ns); }));
  }
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    CAPTURE(bad);
    CHECK(is_refused([=](Message& m) { m.desired_heading_rad(bad); }));
    CHECK(is_refused([=](Message& m) { m.fix().heading_rad(bad); }));
    CHECK(is_refused([=](Message& m) { m.version().x_m(bad); }));
  }
  for (const double bad : {kNan, kInfinity, -kInfinity, 1e5, -1e5}) {
    CAPTURE(bad);
    CHECK(is_refused([=](Message& m) { m.fix().x_m(bad); }));
    CHECK(is_refused([=](Message& m) { m.fix().y_m(bad); }));
  }
  // Unused parts of a command are not read.
  CHECK_FALSE(is_refused([](Message& m) { m.has_fix(false), m.fix().x_m(kNan); }));
  CHECK_FALSE(is_refused([](Message& m) { m.has_version(false), m.version().x_m(kNan); }));
  CHECK_FALSE(is_refused([](Message& m) { m.fix().captured_at_ns(to_ns(Time::min())); }));
  CHECK_FALSE(decode(full_command(), kRobot + 1, kNow));
}

TEST_CASE("feedback with one invalid field is refused") {
  using Message = msg::Feedback;
  const auto is_refused = [](auto spoil) {
    Message message = full_robot_report();
    REQUIRE(decode(message, kRobot, kNow));
    spoil(message);
    return !decode(message, kRobot, kNow);
  };
  CHECK(is_refused([](Message& m) { m.robot(kRobot + 1); }));
  CHECK(is_refused([](Message& m) { m.header().sender(kRobot + 1); }));
  CHECK(is_refused([](Message& m) { m.executing().robot(kRobot + 1); }));
  CHECK(is_refused([](Message& m) { m.executing().phase_count(99); }));
  for (const std::uint64_t number : kHostileNumbers) {
    CHECK(is_refused([=](Message& m) { m.header().incarnation(number); }));
    CHECK(is_refused([=](Message& m) { m.obeyed_incarnation(number); }));
    CHECK(is_refused([=](Message& m) { m.obeyed_epoch(number); }));
    CHECK(is_refused([=](Message& m) { m.executing().version_number(number); }));
    CHECK(is_refused([=](Message& m) { m.executing().incarnation(number); }));
  }
  for (const std::int64_t ns : kHostileTimes_ns) {
    CHECK(is_refused([=](Message& m) { m.executing().start_ns(ns); }));
    CHECK(is_refused([=](Message& m) { m.valid_at_ns(ns); }));
    CHECK(is_refused([=](Message& m) { m.command_stamp_ns(ns); }));
    CHECK(is_refused([=](Message& m) { m.command_received_at_ns(ns); }));
  }
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    CAPTURE(bad);
    CHECK(is_refused([=](Message& m) { m.executing().x_m(bad); }));
    CHECK(is_refused([=](Message& m) { m.x_m(bad); }));
    CHECK(is_refused([=](Message& m) { m.y_m(bad); }));
    CHECK(is_refused([=](Message& m) { m.vx_mps(bad); }));
    CHECK(is_refused([=](Message& m) { m.vy_mps(bad); }));
    CHECK(is_refused([=](Message& m) { m.heading_rad(bad); }));
  }
  for (const double bad : {kNan, kInfinity, -1.0}) {
    CAPTURE(bad);
    CHECK(is_refused([=](Message& m) { m.tracking_error_m(bad); }));
    CHECK(is_refused([=](Message& m) { m.position_error_rms_m(bad); }));
    CHECK(is_refused([=](Message& m) { m.odometry_scale_stddev(bad); }));
  }
  CHECK(is_refused([](Message& m) { m.lead_ns(-1); }));
  CHECK(is_refused([](Message& m) { m.lead_ns(300'000'001); }));
  CHECK_FALSE(decode(full_robot_report(), kRobot + 1, kNow));
}

TEST_CASE("feedback of a robot that has not received a command contains no command") {
  msg::Feedback message = full_robot_report();
  REQUIRE(decode(message, kRobot, kNow)->command);
  message.command_stamp_ns(0);
  REQUIRE(decode(message, kRobot, kNow));
  CHECK_FALSE(decode(message, kRobot, kNow)->command);
}

TEST_CASE("a robot counts as absent if it is lifted and executes no version") {
  RobotReport robot_report;
  CHECK_FALSE(robot_report.is_absent());
  robot_report.is_lifted = true;
  CHECK(robot_report.is_absent());
  robot_report.executing.number = 1;
  CHECK_FALSE(robot_report.is_absent());
}

}  // namespace sidestep::robot_codec_test
