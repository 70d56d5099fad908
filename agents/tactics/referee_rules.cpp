// SPDX-License-Identifier: Apache-2.0
#include "agents/tactics/referee_rules.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "common/geometry/field_marking.hpp"
#include "common/motion/rolling_ball.hpp"

namespace sidestep {
namespace {

/// Speed limit in stopped play: below the rules' 1.5 m/s, because robots may slightly exceed their reference.
constexpr double kStopSpeedLimit_mps = 1.4;
/// Required distance between the edges of robot and ball, as in the rules.
constexpr double kBallDistance_m = 0.5;
/// Allowance for the error of the ball's position, and for its motion until all robots know its new position.
constexpr double kBallAllowance_m = 0.03;
// Robots also leave the line along which the ball will roll within this time, up to a maximum length.
constexpr double kBallLookahead_s = 1, kMaxBallPath_m = 2;
/// A slower ball counts as being at rest, because its measured velocity is noise.
constexpr double kMinBallSpeed_mps = 0.1;
constexpr double kAreaDistance_m = 0.2;  ///< distance from defence areas while the ball is not in play

using league::RefereeCommand;

/// Large enough that the limit also holds for robots that were carried off the field.
constexpr double kFloorMargin_m = 1;

bool is_in_play(RefereeCommand command) {
  return command == RefereeCommand::kNormalStart || command == RefereeCommand::kForceStart;
}

/// Whether the rules for stopped play apply. They also apply in a timeout, when people may be on the field,
/// and after a hold ends, because no robot may be fast before the next command is known.
bool is_stopped(RefereeCommand command) {
  switch (command) {
    case RefereeCommand::kHalt:
    case RefereeCommand::kStop:
    case RefereeCommand::kTimeoutYellow:
    case RefereeCommand::kTimeoutBlue:
    case RefereeCommand::kGoalYellow:
    case RefereeCommand::kGoalBlue:
      return true;
    default:
      return false;
  }
}

bool is_placement(RefereeCommand command) {
  return command == RefereeCommand::kBallPlacementYellow || command == RefereeCommand::kBallPlacementBlue;
}

Zone rectangle(const Vec2& a, const Vec2& b) { return {{a, {b.x(), a.y()}, b, {a.x(), b.y()}}}; }

}  // namespace

RefereeRules::RefereeRules(const Field& field, const RefereeSettings& settings) : settings_(settings) {
  const Vec2 corner(field.length_m / 2, field.width_m / 2);
  floor_ = rectangle(-corner, corner);
  floor_.radius_m = kFloorMargin_m;
  floor_.speed_limit_mps = kStopSpeedLimit_mps;
  const FieldMarking marking(field);
  const double inner_m = corner.x() - marking.area_depth_m, side_m = marking.area_width_m / 2;
  areas_ = {rectangle({-corner.x(), -side_m}, {-inner_m, side_m}),
            rectangle({inner_m, -side_m}, {corner.x(), side_m})};
}

bool RefereeRules::keeps_off_ball(RefereeCommand command) const {
  if (is_stopped(command)) return true;
  const auto team = team_of(command);  // the team that places or kicks the ball
  if (is_placement(command)) return team != settings_.team;
  return team && settings_.team && team != settings_.team;
}

Zone RefereeRules::around_ball(std::vector<Vec2> corners_m) const {
  const double radius_m = RollingBall::kRadius_m + kBallDistance_m + kBallAllowance_m + kZoneTolerance_m;
  return {std::move(corners_m), radius_m};
}

std::optional<Zone> RefereeRules::ball_zone(const league::RefereePacket& packet,
                                            const std::optional<BallState>& ball) const {
  std::vector<Vec2> corners_m;
  if (ball) corners_m.push_back(ball->position_m);
  if (is_placement(packet.command) && packet.designated_position_m)
    corners_m.push_back(*packet.designated_position_m);
  return corners_m.empty() ? std::nullopt : std::optional(around_ball(std::move(corners_m)));
}

std::optional<Zone> RefereeRules::ball_path_zone(const BallState& ball) const {
  const double speed_mps = ball.velocity_mps.norm();
  if (speed_mps < kMinBallSpeed_mps) return std::nullopt;
  const double path_m = std::min(kBallLookahead_s * speed_mps, kMaxBallPath_m);
  return around_ball({ball.position_m, ball.position_m + path_m / speed_mps * ball.velocity_mps});
}

RefereeDemands RefereeRules::demands(const league::RefereePacket& packet,
                                     const std::optional<BallState>& ball) const {
  RefereeDemands demands;
  demands.holds = packet.command == RefereeCommand::kHalt;
  if (is_stopped(packet.command)) demands.zones[kFloorZone] = floor_;
  if (keeps_off_ball(packet.command)) {
    if (const auto zone = ball_zone(packet, ball)) demands.zones[kBallZone] = *zone;
    const auto path = ball ? ball_path_zone(*ball) : std::nullopt;
    if (path) demands.zones[kBallPathZone] = *path;
  }
  if (settings_.closes_defence_areas) {
    demands.zones[kLeftAreaZone] = areas_[0];
    demands.zones[kRightAreaZone] = areas_[1];
    for (const std::uint32_t number : {kLeftAreaZone, kRightAreaZone})
      demands.zones[number].radius_m = is_in_play(packet.command) ? 0 : kAreaDistance_m;
  }
  return demands;
}

bool are_close(const Zone& a, const Zone& b) {
  const auto is_near = [](const Vec2& p, const Vec2& q) { return (p - q).norm() <= kZoneTolerance_m; };
  return a.radius_m == b.radius_m && a.speed_limit_mps == b.speed_limit_mps &&
         std::ranges::equal(a.corners_m, b.corners_m, is_near);
}

}  // namespace sidestep
