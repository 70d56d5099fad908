// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/version_codec.hpp"

#include <chrono>
#include <cmath>

namespace sidestep {
namespace {

constexpr double kMaxInflation_m = 10;
constexpr Duration kMaxPhaseDuration = std::chrono::minutes(1);

// False if the value is NaN.
bool within(double value, double bound) { return std::abs(value) <= bound; }

std::optional<Intent> decode(const msg::Intent& message) {
  const Intent intent{{message.vx_mps(), message.vy_mps()},         message.velocity_duration_s(),
                      {message.via_x_m(), message.via_y_m()},       {message.goal_x_m(), message.goal_y_m()},
                      {message.target_x_m(), message.target_y_m()}, time_from_ns(message.due_ns())};
  const auto is_position = [](const Vec2& p) {
    return within(p.x(), kMaxCoordinate_m) && within(p.y(), kMaxCoordinate_m);
  };
  const bool is_valid =
      within(intent.velocity_mps.x(), kMaxSpeed_mps) && within(intent.velocity_mps.y(), kMaxSpeed_mps) &&
      intent.velocity_duration_s >= 0 && intent.velocity_duration_s <= to_seconds(kMaxPhaseDuration) &&
      is_position(intent.waypoint_m) && is_position(intent.goal_m) && is_position(intent.target_m);
  return is_valid ? std::optional(intent) : std::nullopt;
}

msg::Intent encode(const Intent& intent) {
  msg::Intent message;
  message.vx_mps(static_cast<float>(intent.velocity_mps.x()));
  message.vy_mps(static_cast<float>(intent.velocity_mps.y()));
  message.velocity_duration_s(static_cast<float>(intent.velocity_duration_s));
  message.via_x_m(static_cast<float>(intent.waypoint_m.x()));
  message.via_y_m(static_cast<float>(intent.waypoint_m.y()));
  message.goal_x_m(static_cast<float>(intent.goal_m.x()));
  message.goal_y_m(static_cast<float>(intent.goal_m.y()));
  message.target_x_m(static_cast<float>(intent.target_m.x()));
  message.target_y_m(static_cast<float>(intent.target_m.y()));
  message.due_ns(to_ns(intent.due));
  return message;
}

}  // namespace

std::optional<Version> decode(const msg::Version& message, Time now) {
  const bool is_valid = is_plausible(message.incarnation(), now) &&
                        is_plausible(message.version_number(), now) && is_plausible(message.base(), now) &&
                        is_plausible(time_from_ns(message.start_ns()), now);
  return is_valid ? decode(message) : std::nullopt;
}

std::optional<Version> decode(const msg::Version& message) {
  const double x = message.x_m(), y = message.y_m(), vx = message.vx_mps(), vy = message.vy_mps();
  const double inflation = message.inflation_m();
  const std::int64_t start = message.start_ns();
  const int phases = message.phase_count();
  const RobotId robot = message.robot();
  const bool is_valid = robot < kMaxRobots && phases <= Trajectory::kMaxPhases && start >= 0 &&
                        start <= to_ns(kMaxTime) && within(x, kMaxCoordinate_m) &&
                        within(y, kMaxCoordinate_m) && within(vx, kMaxSpeed_mps) &&
                        within(vy, kMaxSpeed_mps) && inflation >= 0 && inflation <= kMaxInflation_m;
  if (!is_valid) return std::nullopt;
  std::optional<Version> version(Version{robot, message.incarnation(), message.version_number(),
                                         message.base(), Trajectory(time_from_ns(start), {{x, y}, {vx, vy}}),
                                         inflation, std::nullopt});
  if (message.has_intent()) {
    version->intent = decode(message.intent());
    if (!version->intent) return std::nullopt;
  }
  const auto* phase = message.phases().data();
  for (int i = 0; i < phases; ++i, ++phase) {
    const std::int64_t duration = phase->duration_ns();
    const double ax = phase->ax_mps2(), ay = phase->ay_mps2();
    const bool is_valid_phase = duration >= 0 && duration <= kMaxPhaseDuration.count() &&
                                within(ax, kMaxAcceleration_mps2) && within(ay, kMaxAcceleration_mps2);
    if (!is_valid_phase) return std::nullopt;
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
  if (version.intent) message.intent(encode(*version.intent));
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
