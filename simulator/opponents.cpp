// SPDX-License-Identifier: Apache-2.0
#include "simulator/opponents.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

constexpr double kSamePlace_m = 0.001;

}  // namespace

Opponents::Opponents(std::span<const OpponentSpec> specs, std::size_t robots)
    : touching_(specs.size() * robots), robots_(robots) {
  for (const OpponentSpec& spec : specs) {
    Walk walk{.way_m = spec.way_m, .speed_mps = spec.speed_mps, .is_round = false};
    if (walk.way_m.size() > 2 && (walk.way_m.back() - walk.way_m.front()).norm() < kSamePlace_m) {
      walk.is_round = true;
      walk.way_m.pop_back();
    }
    discs_.push_back({walk.way_m.front(), spec.radius_m});
    walks_.push_back(std::move(walk));
  }
}

void Opponents::head_on(Walk& walk) {
  const std::size_t last = walk.way_m.size() - 1;
  if (walk.is_round) {
    walk.next = walk.next == last ? 0 : walk.next + 1;
    return;
  }
  if (walk.next == last) walk.is_going_back = true;
  if (walk.next == 0) walk.is_going_back = false;
  walk.next = walk.is_going_back ? walk.next - 1 : walk.next + 1;
}

void Opponents::move(Walk& walk, Vec2& position_m) const {
  walk.velocity_mps.setZero();
  if (walk.way_m.size() == 1) return;
  double left_m = walk.speed_mps * kPhysicsStepSeconds;
  // Points that lie on each other must not keep it busy for ever.
  for (std::size_t passed = 0; passed <= 2 * walk.way_m.size(); ++passed) {
    const Vec2 ahead = walk.way_m[walk.next] - position_m;
    const double distance = ahead.norm();
    if (distance > left_m) {
      position_m += ahead * (left_m / distance);
      walk.velocity_mps = ahead * (walk.speed_mps / distance);
      return;
    }
    left_m -= distance;
    position_m = walk.way_m[walk.next];
    head_on(walk);
  }
}

void Opponents::step(std::span<const Body> robots, double robot_radius_m) {
  for (std::size_t i = 0; i < walks_.size(); ++i) {
    move(walks_[i], discs_[i].centre_m);
    const double near = discs_[i].radius_m + robot_radius_m + kApart_m;
    for (std::size_t robot = 0; robot < robots.size(); ++robot) {
      const Vec2 apart = robots[robot].position_m() - discs_[i].centre_m;
      if (apart.squaredNorm() < near * near && robots[robot].is_on_floor()) {
        look_at(i, robot, robots[robot], robot_radius_m);
      } else if (touching_[i * robots_ + robot]) {
        touching_[i * robots_ + robot] = false;
      }
    }
  }
}

void Opponents::look_at(std::size_t opponent, std::size_t robot, const Body& body, double robot_radius_m) {
  const Circle& disc = discs_[opponent];
  const Vec2 apart = body.position_m() - disc.centre_m;
  const double distance = apart.norm();
  if (distance >= disc.radius_m + robot_radius_m || touching_[opponent * robots_ + robot]) return;
  touching_[opponent * robots_ + robot] = true;
  const Vec2 away = distance > 0 ? Vec2(apart / distance) : Vec2(1, 0);
  const double share = std::max(0.0, -body.velocity_mps().dot(away));
  const double closing = (walks_[opponent].velocity_mps - body.velocity_mps()).dot(away);
  ++totals_.crashes;
  if (body.velocity_mps().norm() > kAtRest_mps) ++totals_.moving_crashes;
  totals_.crash_speed_mps = std::max(totals_.crash_speed_mps, closing);
  totals_.robot_crash_speed_mps = std::max(totals_.robot_crash_speed_mps, share);
}

}  // namespace sidestep
