// SPDX-License-Identifier: Apache-2.0
#include "vision/league/tracked_output.hpp"

#include <fmt/format.h>

#include "common/random/rng.hpp"

namespace sidestep {
namespace {

constexpr std::int64_t kVisibleFor_ns = 100'000'000;

/// A random UUID (RFC 4122, version 4).
std::string random_uuid(Rng rng) {
  const std::uint64_t high = (rng.bits() & ~0xf000ULL) | 0x4000,
                      low = (rng.bits() & ~(3ULL << 62)) | 2ULL << 62;
  return fmt::format("{:08x}-{:04x}-{:04x}-{:04x}-{:012x}", high >> 32, high >> 16 & 0xffff, high & 0xffff,
                     low >> 48, low & 0xffff'ffff'ffff);
}

}  // namespace

TrackedOutput::TrackedOutput(const Scenario& scenario, Incarnation incarnation) : scenario_(scenario) {
  require_unique_numbers(scenario);
  packet_.uuid = random_uuid(Rng(incarnation));
  packet_.source_name = "Sidestep";
  packet_.frame.emplace();
}

const league::TrackedPacket& TrackedOutput::packet_of(const msg::WorldState& world) {
  league::TrackedFrame& frame = *packet_.frame;
  ++frame.frame_number;
  frame.at = Duration{world.valid_at_ns()};
  frame.robots.clear();
  for (const msg::TrackedRobot& robot : world.robots()) {
    const RobotSpec* const spec = find_robot(scenario_, robot.robot());
    if (!spec) continue;
    league::TrackedRobot tracked;
    tracked.team = spec->team;
    tracked.number = number_in_team(spec->id);
    tracked.position_m = {robot.x_m(), robot.y_m()};
    tracked.heading_rad = wrapped_rad(robot.heading_rad());
    tracked.velocity_mps = {robot.vx_mps(), robot.vy_mps()};
    tracked.angular_radps = robot.angular_radps();
    tracked.visibility = world.valid_at_ns() - robot.observed_at_ns() <= kVisibleFor_ns ? 1 : 0;
    frame.robots.push_back(tracked);
  }
  frame.balls.clear();
  if (const msg::TrackedBall& ball = world.ball(); ball.is_visible()) {
    frame.balls.push_back({{ball.x_m(), ball.y_m(), 0}, Vec3(ball.vx_mps(), ball.vy_mps(), 0), 1});
  }
  return packet_;
}

}  // namespace sidestep
