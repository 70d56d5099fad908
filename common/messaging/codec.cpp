// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/codec.hpp"

#include <chrono>
#include <cmath>

namespace sidestep {
namespace {

constexpr double kLargestPosition_m = 1e4;
constexpr double kLargestSpeed_mps = 100;
constexpr double kMaxInflation_m = 10;
constexpr double kLargestAcceleration_mps2 = 1000;
constexpr Duration kLongestPhase = std::chrono::minutes(1);
constexpr std::int64_t kLatestStart_ns = std::int64_t{1} << 62;

// Written so that a NaN fails it.
bool within(double value, double bound) { return std::abs(value) <= bound; }

/// A hold that is longer than a phase may be is nobody's.
std::optional<Intent> decode(const msg::Intent& message) {
  const Intent intent{{message.vx_mps(), message.vy_mps()},
                      message.hold_s(),
                      {message.via_x_m(), message.via_y_m()},
                      {message.goal_x_m(), message.goal_y_m()}};
  const auto is_place = [](const Vec2& p) {
    return within(p.x(), kLargestPosition_m) && within(p.y(), kLargestPosition_m);
  };
  const bool sound = within(intent.velocity_mps.x(), kLargestSpeed_mps) &&
                     within(intent.velocity_mps.y(), kLargestSpeed_mps) && intent.hold_s >= 0 &&
                     intent.hold_s <= to_seconds(kLongestPhase) && is_place(intent.waypoint_m) &&
                     is_place(intent.goal_m);
  return sound ? std::optional(intent) : std::nullopt;
}

msg::Intent encode(const Intent& intent) {
  msg::Intent message;
  message.vx_mps(static_cast<float>(intent.velocity_mps.x()));
  message.vy_mps(static_cast<float>(intent.velocity_mps.y()));
  message.hold_s(static_cast<float>(intent.hold_s));
  message.via_x_m(static_cast<float>(intent.waypoint_m.x()));
  message.via_y_m(static_cast<float>(intent.waypoint_m.y()));
  message.goal_x_m(static_cast<float>(intent.goal_m.x()));
  message.goal_y_m(static_cast<float>(intent.goal_m.y()));
  return message;
}

}  // namespace

// Each field is read once: their accessors are calls, and every agent reads many versions in every cycle.
std::optional<Version> decode(const msg::Version& message) {
  const double x = message.x_m(), y = message.y_m(), vx = message.vx_mps(), vy = message.vy_mps();
  const double grown = message.inflation_m();
  const std::int64_t start = message.start_ns();
  const int phases = message.phase_count();
  const RobotId robot = message.robot();
  const bool sound = robot < kMaxRobots && phases <= Trajectory::kMaxPhases && start >= 0 &&
                     start <= kLatestStart_ns && within(x, kLargestPosition_m) &&
                     within(y, kLargestPosition_m) && within(vx, kLargestSpeed_mps) &&
                     within(vy, kLargestSpeed_mps) && grown >= 0 && grown <= kMaxInflation_m;
  if (!sound) return std::nullopt;
  std::optional<Version> version(Version{robot, message.incarnation(), message.version_number(),
                                         message.base(), Trajectory(time_from_ns(start), {{x, y}, {vx, vy}}),
                                         grown, std::nullopt});
  if (message.has_intent()) {
    version->intent = decode(message.intended());
    if (!version->intent) return std::nullopt;
  }
  const auto* phase = message.phases().data();
  for (int i = 0; i < phases; ++i, ++phase) {
    const std::int64_t duration = phase->duration_ns();
    const double ax = phase->ax_mps2(), ay = phase->ay_mps2();
    const bool is_sound = duration >= 0 && duration <= kLongestPhase.count() &&
                          within(ax, kLargestAcceleration_mps2) && within(ay, kLargestAcceleration_mps2);
    if (!is_sound) return std::nullopt;
    version->trajectory.append(Duration{duration}, {ax, ay});
  }
  return version;
}

msg::Version encode(const Version& version) {
  const Trajectory& trajectory = version.trajectory;
  msg::Version message;
  message.robot(version.robot);
  message.incarnation(version.incarnation);
  message.version_number(version.number);
  message.base(version.base);
  message.start_ns(to_ns(trajectory.start()));
  message.x_m(trajectory.at_start().position_m.x());
  message.y_m(trajectory.at_start().position_m.y());
  message.vx_mps(trajectory.at_start().velocity_mps.x());
  message.vy_mps(trajectory.at_start().velocity_mps.y());
  message.inflation_m(version.inflation_m);
  message.has_intent(version.intent.has_value());
  if (version.intent) message.intended(encode(*version.intent));
  message.phase_count(static_cast<std::uint8_t>(trajectory.phases().size()));
  auto slot = message.phases().begin();
  for (const MotionPhase& phase : trajectory.phases()) {
    slot->duration_ns(phase.duration.count());
    slot->ax_mps2(phase.acceleration_mps2.x());
    slot->ay_mps2(phase.acceleration_mps2.y());
    ++slot;
  }
  return message;
}

}  // namespace sidestep
