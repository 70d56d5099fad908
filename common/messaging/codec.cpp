// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/codec.hpp"

#include <chrono>
#include <cmath>

namespace sidestep {
namespace {

constexpr double kLargestPosition_m = 1e4;
constexpr double kLargestSpeed_mps = 100;
constexpr double kLargestGrowth_m = 10;
constexpr double kLargestAcceleration_mps2 = 1000;
constexpr Duration kLongestPhase = std::chrono::minutes(1);
constexpr std::int64_t kLatestStart_ns = std::int64_t{1} << 62;

// Written so that a NaN fails it.
bool within(double value, double bound) { return std::abs(value) <= bound; }

bool is_sound(const msg::Phase& phase) {
  return phase.duration_ns() >= 0 && phase.duration_ns() <= kLongestPhase.count() &&
         within(phase.ax_mps2(), kLargestAcceleration_mps2) &&
         within(phase.ay_mps2(), kLargestAcceleration_mps2);
}

}  // namespace

std::optional<Version> decode(const msg::Version& message) {
  const bool sound = message.robot() < kMaxRobots && message.phase_count() <= Trajectory::kMaxPhases &&
                     message.start_ns() >= 0 && message.start_ns() <= kLatestStart_ns &&
                     within(message.x_m(), kLargestPosition_m) && within(message.y_m(), kLargestPosition_m) &&
                     within(message.vx_mps(), kLargestSpeed_mps) &&
                     within(message.vy_mps(), kLargestSpeed_mps) && message.grown_m() >= 0 &&
                     message.grown_m() <= kLargestGrowth_m;
  if (!sound) return std::nullopt;
  Trajectory trajectory(time_from_ns(message.start_ns()),
                        {{message.x_m(), message.y_m()}, {message.vx_mps(), message.vy_mps()}});
  for (int i = 0; i < message.phase_count(); ++i) {
    const msg::Phase& phase = message.phases()[static_cast<std::size_t>(i)];
    if (!is_sound(phase)) return std::nullopt;
    trajectory.append(Duration{phase.duration_ns()}, {phase.ax_mps2(), phase.ay_mps2()});
  }
  return Version{message.robot(), message.incarnation(), message.version_number(), message.base(),
                 trajectory,      message.grown_m()};
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
  message.grown_m(version.grown_m);
  message.phase_count(static_cast<std::uint8_t>(trajectory.phases().size()));
  auto slot = message.phases().begin();
  for (const Phase& phase : trajectory.phases()) {
    slot->duration_ns(phase.duration.count());
    slot->ax_mps2(phase.acceleration_mps2.x());
    slot->ay_mps2(phase.acceleration_mps2.y());
    ++slot;
  }
  return message;
}

}  // namespace sidestep
