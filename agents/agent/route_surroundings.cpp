// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/route_surroundings.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "agents/agent/planning_distances.hpp"

namespace sidestep {
namespace {

/// A robot at rest for longer than this counts as an obstacle.
constexpr Duration kStationaryAfter{500'000'000};
constexpr std::size_t kMaxStationary = 8;  ///< number of nearest stationary robots that are considered
constexpr std::size_t kMaxMoving = 8;      ///< number of nearest moving obstacles that are considered
/// An obstacle that moves and is farther away is ignored: it will be elsewhere by the time the robot gets
/// there. One that stands is not. A robot that saw it only from some places of its way would choose one route
/// at these places and another one elsewhere, and could turn around between them for ever.
constexpr double kMovingRange_m = 1.5;
constexpr double kStanding_mps = 0.3;  ///< an obstacle whose estimated speed is lower counts as standing
/// Positions and radii of moving obstacles are rounded to this grid to avoid replanning in every cycle.
constexpr double kMovingGrid_m = 0.05;
// A lag changes when an obstacle was observed, which routes do not depend on.
constexpr Duration kNoLag{0};
constexpr Duration kMovingHorizon{150'000'000};  ///< radii are enlarged by the motion over this time

}  // namespace

std::vector<TemporaryObstacle> RouteSurroundings::find(const Vec2& target, Time now,
                                                       Observations& observations,
                                                       const Assignment& assignment,
                                                       const OccludedCorners& corners,
                                                       Duration reaction) const {
  const Vec2& position = observations.own().estimate().position_m;
  std::vector<TemporaryObstacle> found;
  if (const RobotLaser* laser = observations.laser())
    found = find_in_sight(target, *laser, corners, reaction);
  for (const Circle& circle : find_moving(target, now, observations)) found.push_back({circle});
  for (const Neighbours::Stationary& other :
       observations.neighbours().find_stationary(now - kStationaryAfter, position, kMaxStationary)) {
    // A robot on the target that is about to leave is no reason to go elsewhere.
    const bool covers = (other.position_m - target).norm() <= rules_.radius_m + required_separation_m(rules_);
    if (!covers || will_stay(other, assignment, position))
      found.push_back({{other.position_m, rules_.radius_m}, other.robot});
  }
  return found;
}

std::vector<TemporaryObstacle> RouteSurroundings::find_in_sight(const Vec2& target, const RobotLaser& laser,
                                                                const OccludedCorners& corners,
                                                                Duration reaction) const {
  std::vector<TemporaryObstacle> found;
  const auto add = [&](const Circle& circle) {
    if (signed_distance(target, Shape(circle)) > required_separation_m(rules_)) found.push_back({circle});
  };
  for (const Circle& square : laser.sight().unknown()) add(square);
  // At this distance from the corner, the robot can pass slowly.
  const double radius_m = laser.approach_m(reaction);
  corners.for_each_corner_m([&](const Vec2& corner) { add({corner, radius_m}); });
  return found;
}

std::vector<Circle> RouteSurroundings::find_moving(const Vec2& target, Time now,
                                                   Observations& observations) const {
  const Vec2& position = observations.own().estimate().position_m;
  std::vector<Circle> found;
  const auto add = [&](const MovingObstacle& obstacle) {
    const bool stands = obstacle.velocity_mps.norm() < kStanding_mps;
    if (!stands && (obstacle.position_m - position).norm() > kMovingRange_m) return;
    const Vec2 centre = (obstacle.position_m / kMovingGrid_m).array().round().matrix() * kMovingGrid_m;
    const double radius = std::round(obstacle.radius_m / kMovingGrid_m) * kMovingGrid_m;
    // The inflated circle must not cover the target.
    const double max_inflation =
        (centre - target).norm() - radius - planning_separation_m(rules_) - kAtGoal_m;
    const double inflation = kMovingGrid_m + obstacle.speed_mps * to_seconds(kMovingHorizon);
    found.push_back({centre, radius + std::clamp(max_inflation, 0.0, inflation)});
  };
  if (const RobotLaser* laser = observations.laser()) {
    // Routes keep a large distance from walls in order to see around corners early, but this is not needed
    // near people. If people are in the way, the robot waits rather than squeezing past along a wall.
    const double less_m = kClearancesInSight_m.front() - kExtraClearance_m;
    for (const LaserTrack& track : laser->sight().tracks())
      add({track.position_m, std::max(0.05, track.radius_m - less_m), track.seen_at, 0, track.velocity_mps});
  } else {
    for (const MovingObstacle& obstacle : observations.obstacles().recent(now, kNoLag)) add(obstacle);
  }
  for (const UncontrolledBody& body : observations.displaced().recent(now, kNoLag)) add(body.reach);
  std::ranges::sort(found, {}, [&](const Circle& c) { return (c.centre_m - position).squaredNorm(); });
  if (found.size() > kMaxMoving) found.resize(kMaxMoving);
  std::ranges::sort(found, {}, [](const Circle& c) { return std::pair(c.centre_m.x(), c.centre_m.y()); });
  return found;
}

bool RouteSurroundings::will_stay(const Neighbours::Stationary& other, const Assignment& assignment,
                                  const Vec2& position) const {
  const OtherAssignment orders = assignment.other(other.robot);
  if (orders.is_held || !orders.has_drive_order) return true;
  // The other robot waits as near to its goal as it can get. But if this robot blocks the other robot's way,
  // one of the robots must move.
  const bool waits = other.intent && (other.position_m - other.intent->goal_m).norm() < kNeighbourAtGoal_m;
  return waits && orders.goal_m &&
         (position - *orders.goal_m).norm() > rules_.radius_m + planning_separation_m(rules_);
}

}  // namespace sidestep
