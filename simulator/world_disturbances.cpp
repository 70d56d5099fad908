// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "simulator/world.hpp"

namespace sidestep {
namespace {

// A robot is put down on its stand, when that lies so near to the place that was asked for.
constexpr double kSamePlace_m = 0.005;

}  // namespace

bool World::disturb(std::size_t index, const msg::Disturbance& what, Time now) {
  Robot& robot = robots_[index];
  Body& body = bodies_[index];
  const auto kind = what.disturbance_kind();
  const Time until = now + Duration{what.duration_ns()};
  switch (kind) {
    case msg::DISTURBANCE_PUSH:
      if (!body.is_on_floor()) return false;
      body.shove({what.vx_mps(), what.vy_mps()});
      note_hand(index, now);
      return true;
    case msg::DISTURBANCE_SLIP:
      body.set_grip(what.grip());
      start_effect({index, kind, until, Vec2(0, 0), 0});
      note_hand(index, now);
      return true;
    case msg::DISTURBANCE_BLOCK:
      body.set_blocked(what.heading_rad());
      start_effect({index, kind, until, Vec2(0, 0), 0});
      note_hand(index, now);
      return true;
    case msg::DISTURBANCE_LIFT:
      lift(index, now);
      return true;
    case msg::DISTURBANCE_PLACE:
      if (body.is_on_floor()) return false;
      start_effect({index, kind, Time::max(), {what.x_m(), what.y_m()}, what.heading_rad()});
      return true;
    case msg::DISTURBANCE_REBOOT:
      if (!body.is_on_floor()) {
        lift(index, now);
      } else {
        robot.firmware.reboot();
        robot.judge.rebooted();
      }
      note_hand(index, now);
      return true;
    case msg::DISTURBANCE_CLOCK:
      robot_time(index, now);
      robot.clock_offset = Duration{what.clock_offset_ns()};
      return true;
  }
  return false;
}

void World::lift(std::size_t index, Time now) {
  stop_effects(index, msg::DISTURBANCE_PLACE);
  const Time clock = robot_time(index, now);
  switch_versions(index, clock);
  bodies_[index].lift();
  robots_[index].firmware.lift(clock);
  robots_[index].judge.lifted();
  robots_[index].desired = {};
  contacts_.search_again();
  opponents_.search_again();
  note_hand(index, now);
  note_news(index);
}

void World::note_hand(std::size_t index, Time at) {
  std::optional<Time>& last = robots_[index].last_hand;
  last = std::max(last.value_or(at), at);
}

std::optional<Time> World::let_go(std::size_t index) const {
  std::optional<Time> last = robots_[index].last_hand;
  for (const Effect& effect : effects_) {
    if (effect.robot == index && effect.kind != msg::DISTURBANCE_PLACE)
      last = std::max(last.value_or(effect.until), effect.until);
  }
  return last;
}

void World::start_effect(const Effect& effect) {
  stop_effects(effect.robot, effect.kind);
  effects_.push_back(effect);
}

void World::stop_effects(std::size_t robot, msg::DisturbanceKind kind) {
  std::erase_if(effects_, [&](const Effect& effect) { return effect.robot == robot && effect.kind == kind; });
}

void World::end_effects() {
  std::erase_if(effects_, [this](const Effect& effect) {
    if (effect.kind == msg::DISTURBANCE_PLACE) return put_down(effect);
    if (effect.until > time_) return false;
    note_hand(effect.robot, effect.until);
    if (effect.kind == msg::DISTURBANCE_SLIP)
      bodies_[effect.robot].set_grip(1);
    else
      bodies_[effect.robot].set_blocked(std::nullopt);
    return true;
  });
}

bool World::put_down(const Effect& desired) {
  Robot& robot = robots_[desired.robot];
  const Version& stand = robot.firmware.executing();
  const Vec2 place_m = stand.trajectory.rest_position_m();
  if (stand.number == 0 || (place_m - desired.place_m).norm() > kSamePlace_m) return false;
  bodies_[desired.robot].put_down(place_m, desired.heading_rad);
  robot.firmware.put_down(desired.heading_rad, robot_time(desired.robot, time_));
  robot.judge.put_down();
  note_hand(desired.robot, time_);
  robot.last_position_m = bodies_[desired.robot].rolled_to_m();
  robot.last_heading_rad = desired.heading_rad;
  contacts_.search_again();
  opponents_.search_again();
  note_news(desired.robot);
  return true;
}

}  // namespace sidestep
