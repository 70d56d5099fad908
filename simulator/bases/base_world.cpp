// SPDX-License-Identifier: Apache-2.0
#include "simulator/bases/base_world.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

#include "simulator/world/opponents.hpp"

namespace sidestep {
namespace {

// Ids of opponents: these first ids plus the robot's number in its team.
constexpr RobotId kFirstBlueOpponent = kMaxRobots - 32, kFirstYellowOpponent = kMaxRobots - 16;
// Time after an opponent's push during which a robot's motion may be an effect of the push.
constexpr Duration kMaxPushEffect = std::chrono::seconds(1);
constexpr double kReach_m = 0.015, kFrontAngle_rad = 0.45;

Scenario with_opponents(const Scenario& scenario, std::uint32_t team_size) {
  require_unique_numbers(scenario);
  if (team_size > 0 && !scenario.robots.empty() && scenario.robots.back().id >= kFirstBlueOpponent)
    throw std::invalid_argument(
        fmt::format("robot numbers from {} on are reserved for opponents, but scenario {} has robot {}",
                    kFirstBlueOpponent, scenario.name, scenario.robots.back().id));
  Scenario floor = scenario;
  const double spacing_m = 2.5 * scenario.radius_m;
  for (const Team team : {Team::kBlue, Team::kYellow}) {
    const double side = team == Team::kBlue ? -1 : 1;
    int place = 0;
    for (std::uint32_t number = 0; number < team_size; ++number) {
      if (find_robot(scenario, team, number)) continue;
      RobotSpec opponent;
      opponent.id = (team == Team::kBlue ? kFirstBlueOpponent : kFirstYellowOpponent) + number;
      opponent.team = team;
      opponent.start_m = {side * spacing_m * (++place), scenario.field.width_m / 2 - 1.2 * scenario.radius_m};
      opponent.start_heading_rad = -1.5707963;
      floor.robots.push_back(opponent);
    }
  }
  return floor;
}

}  // namespace

BaseWorld::BaseWorld(const Scenario& scenario, std::uint32_t team_size, const BaseSettings& settings,
                     Time begin)
    : scenario_robot_count_(scenario.robots.size()),
      floor_(with_opponents(scenario, team_size)),
      settings_(settings),
      time_(begin),
      controls_(floor_.robots.size(), BaseControl(settings)),
      pushed_at_(floor_.robots.size(), Time::min()),
      placed_at_(floor_.robots.size()),
      contacts_(scenario.obstacles, scenario.map, scenario.radius_m, BaseControl::kMaxSpeed_mps),
      speeds_mps_(floor_.robots.size()) {
  for (const RobotSpec& robot : floor_.robots) {
    bodies_.emplace_back(robot.start_m, robot.start_heading_rad, body_settings(settings));
    if (robot.is_absent) bodies_.back().lift();
  }
  if (scenario.ball) set_ball({scenario.ball->position_m, scenario.ball->velocity_mps});
}

std::optional<std::size_t> BaseWorld::find(Team team, std::uint32_t number) const {
  const auto found = std::ranges::find_if(floor_.robots, [&](const RobotSpec& robot) {
    return robot.team == team && number_in_team(robot.id) == number;
  });
  if (found == floor_.robots.end()) return std::nullopt;
  return static_cast<std::size_t>(found - floor_.robots.begin());
}

void BaseWorld::place(std::size_t robot, const Vec2& position_m, double heading_rad) {
  bodies_[robot] = Body(position_m, heading_rad, body_settings(settings_));
  controls_[robot].reset();
  placed_at_[robot] = time_;
  contacts_.invalidate_near_pairs();
}

void BaseWorld::remove(std::size_t robot) {
  bodies_[robot].lift();
  contacts_.invalidate_near_pairs();
}

void BaseWorld::set_ball(const State& state) { ball_.emplace(state); }

bool BaseWorld::has_ball(std::size_t robot) const {
  const Body& body = bodies_[robot];
  if (!ball_ || !body.is_on_floor()) return false;
  const Vec2 to_ball = rotated(Vec2(ball_->state().position_m - body.position_m()), -body.heading_rad());
  const double gap_m = to_ball.norm() - floor_.radius_m - RollingBall::kRadius_m;
  return gap_m < kReach_m && std::abs(std::atan2(to_ball.y(), to_ball.x())) < kFrontAngle_rad;
}

bool BaseWorld::kick(std::size_t robot, double speed_mps) {
  if (!has_ball(robot)) return false;
  const Body& body = bodies_[robot];
  set_ball(
      {ball_->state().position_m, body.velocity_mps() + rotated(Vec2(speed_mps, 0), body.heading_rad())});
  return true;
}

void BaseWorld::advance(Time to) {
  while (to - time_ >= kPhysicsStep) step();
}

void BaseWorld::step() {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    bodies_[i].step(controls_[i].actuation(bodies_[i], time_));
    speeds_mps_[i] = bodies_[i].velocity_mps().norm();
  }
  time_ += kPhysicsStep;
  contacts_.step(bodies_);
  count_contacts(speeds_mps_);
  measure_clearance();
  if (ball_) ball_->step(floor_.field, floor_.obstacles, floor_.map.get(), bodies_, floor_.radius_m);
}

// Measures the clearance between the scenario's robots; contacts_ also measures clearances from opponents.
void BaseWorld::measure_clearance() {
  if (scenario_robot_count_ == bodies_.size()) return;
  for (std::size_t i = 0; i < scenario_robot_count_; ++i) {
    for (std::size_t k = i + 1; k < scenario_robot_count_; ++k) {
      if (!bodies_[i].is_on_floor() || !bodies_[k].is_on_floor()) continue;
      const double distance_m = (bodies_[i].position_m() - bodies_[k].position_m()).norm();
      min_clearance_m_ = std::min(min_clearance_m_, distance_m - 2 * floor_.radius_m);
    }
  }
}

void BaseWorld::count_contacts(const std::vector<double>& speeds_mps) {
  const ContactTotals& totals = contacts_.totals();
  const std::uint64_t kept = std::min<std::uint64_t>(totals.contacts - seen_contacts_, msg::MAX_CONTACTS);
  for (std::uint64_t k = totals.contacts - kept; k < totals.contacts; ++k) {
    const ContactPair& pair = totals.recent_contacts[k % msg::MAX_CONTACTS];
    const std::size_t first = pair.first, second = pair.second;
    const bool is_robot = second < bodies_.size();
    if (is_ours(first) && (!is_robot || is_ours(second))) {
      recent_contacts_[contact_count_++ % msg::MAX_CONTACTS] = pair;
      continue;
    }
    const std::size_t robot = is_ours(first) ? first : second;
    if (!is_robot || !is_ours(robot)) continue;  // not a crash of a robot with an opponent
    ++crashes_;
    const bool was_pushed = time_ - kMaxPushEffect < pushed_at_[robot];
    pushed_at_[robot] = time_;
    if (was_pushed || speeds_mps[robot] <= Opponents::kAtRest_mps) continue;
    max_crash_mps_ = std::max(max_crash_mps_, speeds_mps[robot]);
    recent_moving_crashes_[moving_crashes_++ % msg::MAX_CONTACTS] = floor_.robots[robot].id;
  }
  seen_contacts_ = totals.contacts;
}

void BaseWorld::fill(msg::GroundTruth& truth) const {
  truth.valid_at_ns(to_ns(time_));
  truth.contacts(contact_count_);
  for (std::size_t i = 0; i < std::min<std::size_t>(contact_count_, msg::MAX_CONTACTS); ++i) {
    const ContactPair& contact = recent_contacts_[i];
    truth.recent_contacts()[i].first(floor_.robots[contact.first].id);
    truth.recent_contacts()[i].second(contact.second < bodies_.size() ? floor_.robots[contact.second].id
                                                                      : msg::NO_ROBOT);
  }
  truth.penetration_m_s(contacts_.totals().penetration_m_s);
  truth.min_clearance_m(scenario_robot_count_ == bodies_.size() ? contacts_.totals().min_clearance_m
                                                                : min_clearance_m_);
  truth.crashes(crashes_);
  truth.crashes_while_moving(moving_crashes_);
  for (std::size_t i = 0; i < std::min<std::size_t>(moving_crashes_, msg::MAX_CONTACTS); ++i)
    truth.recent_moving_crashes()[i] = recent_moving_crashes_[i];
  truth.max_robot_crash_speed_mps(max_crash_mps_);
  truth.max_crash_speed_mps(max_crash_mps_);
  const Vec2 ball_m = ball_ ? ball_->state().position_m : Vec2(0, 0);
  truth.ball_x_m(ball_m.x());
  truth.ball_y_m(ball_m.y());
  truth.robots().clear();
  for (std::size_t i = 0; i < scenario_robot_count_; ++i) {
    const Body& body = bodies_[i];
    if (!body.is_on_floor()) continue;
    msg::TrueRobotState robot;
    robot.robot(floor_.robots[i].id);
    robot.x_m(body.position_m().x());
    robot.y_m(body.position_m().y());
    robot.heading_rad(wrapped_rad(body.heading_rad()));
    robot.vx_mps(body.velocity_mps().x());
    robot.vy_mps(body.velocity_mps().y());
    robot.reference_error_m(-1);
    robot.disturbance_end_ns(placed_at_[i] ? to_ns(*placed_at_[i]) : -1);
    truth.robots().push_back(robot);
  }
}

}  // namespace sidestep
