// SPDX-License-Identifier: Apache-2.0
#include "simulator/opponents.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace sidestep {
namespace {

constexpr double kSamePlace_m = 0.001;
constexpr int kStepsBetweenSearches = 20;
constexpr double kPushed_m = 0.02;  // by which contacts may move a robot between two searches

}  // namespace

Opponents::Opponents(std::span<const OpponentSpec> specs, double robot_radius_m, double robot_speed_limit_mps)
    : radius_m_(robot_radius_m), speed_limit_mps_(robot_speed_limit_mps) {
  for (const OpponentSpec& spec : specs) {
    Walk walk{.path_m = spec.path_m, .speed_mps = spec.speed_mps, .is_round = false};
    if (walk.path_m.size() > 2 && (walk.path_m.back() - walk.path_m.front()).norm() < kSamePlace_m) {
      walk.is_round = true;
      walk.path_m.pop_back();
    }
    discs_.push_back({walk.path_m.front(), spec.radius_m});
    walks_.push_back(std::move(walk));
  }
}

void Opponents::head_on(Walk& walk) {
  const std::size_t last = walk.path_m.size() - 1;
  if (walk.is_round) {
    walk.next = walk.next == last ? 0 : walk.next + 1;
    return;
  }
  if (walk.next == last) walk.is_going_back = true;
  if (walk.next == 0) walk.is_going_back = false;
  walk.next = walk.is_going_back ? walk.next - 1 : walk.next + 1;
}

void Opponents::move(Walk& walk, Vec2& position_m) {
  walk.velocity_mps.setZero();
  if (walk.path_m.size() == 1) return;
  double left_m = walk.speed_mps * kPhysicsStepSeconds;
  // Points that lie on each other must not keep it busy for ever.
  for (std::size_t passed = 0; passed <= 2 * walk.path_m.size(); ++passed) {
    const Vec2 ahead = walk.path_m[walk.next] - position_m;
    const double distance = ahead.norm();
    if (distance > left_m) {
      position_m += ahead * (left_m / distance);
      walk.velocity_mps = ahead * (walk.speed_mps / distance);
      return;
    }
    left_m -= distance;
    position_m = walk.path_m[walk.next];
    head_on(walk);
  }
}

void Opponents::step(std::span<const Body> robots) {
  for (std::size_t i = 0; i < walks_.size(); ++i) move(walks_[i], discs_[i].centre_m);
  if (steps_to_next_search_ == 0) {
    find_near(robots);
    steps_to_next_search_ = kStepsBetweenSearches;
  }
  --steps_to_next_search_;
  for (Pair& pair : near_) look_at(pair, robots[pair.robot]);
}

void Opponents::find_near(std::span<const Body> robots) {
  touching_.clear();
  std::copy_if(near_.begin(), near_.end(), std::back_inserter(touching_),
               [](const Pair& pair) { return pair.is_touching; });
  near_.clear();
  for (std::uint32_t i = 0; i < walks_.size(); ++i) {
    const double travel =
        (speed_limit_mps_ + walks_[i].speed_mps) * kStepsBetweenSearches * kPhysicsStepSeconds;
    const double near = discs_[i].radius_m + radius_m_ + kApart_m + kPushed_m + travel;
    for (std::uint32_t robot = 0; robot < robots.size(); ++robot) {
      if ((robots[robot].position_m() - discs_[i].centre_m).squaredNorm() > near * near) continue;
      if (!robots[robot].is_on_floor()) continue;
      const bool touches = std::any_of(touching_.begin(), touching_.end(), [&](const Pair& pair) {
        return pair.opponent == i && pair.robot == robot;
      });
      near_.push_back({i, robot, touches});
    }
  }
}

void Opponents::look_at(Pair& pair, const Body& body) {
  const Circle& disc = discs_[pair.opponent];
  const Vec2 apart = body.position_m() - disc.centre_m;
  const double distance = apart.norm();
  const double clearance = distance - disc.radius_m - radius_m_;
  if (clearance > kApart_m) pair.is_touching = false;
  if (clearance >= 0 || pair.is_touching) return;
  pair.is_touching = true;
  const Vec2 away = distance > 0 ? Vec2(apart / distance) : Vec2(1, 0);
  const double share = std::max(0.0, -body.velocity_mps().dot(away));
  const double closing = (walks_[pair.opponent].velocity_mps - body.velocity_mps()).dot(away);
  ++totals_.crashes;
  if (body.velocity_mps().norm() > kAtRest_mps) ++totals_.moving_crashes;
  totals_.crash_speed_mps = std::max(totals_.crash_speed_mps, closing);
  totals_.robot_crash_speed_mps = std::max(totals_.robot_crash_speed_mps, share);
}

}  // namespace sidestep
