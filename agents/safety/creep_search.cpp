// SPDX-License-Identifier: Apache-2.0
#include "agents/safety/creep_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace sidestep {
namespace {

constexpr int kDirections = 32;
/// A robot that cannot move although strangers need at least this long to reach it is not held up by them.
constexpr Duration kSoon{50'000'000};
/// A creeping robot stops within this time.
constexpr Duration kCreepingStop{20'000'000};
/// The speed is lower than permitted by this factor, so that rounding does not exceed the limit.
constexpr double kSpeedFactor = 0.99;

/// The strangers from whom the robot must creep away: those that may reach it before it stops from creeping.
/// If there are none, the nearest one that may reach it soon: then faster motions may be unsafe too.
class NearStrangers {
 public:
  NearStrangers(const SearchQuery& query, double min_separation_m)
      : query_(query),
        min_separation_m_(min_separation_m),
        stop_(query.start + query.hold_time + kCreepingStop) {
    double least_m = min_separation_m;
    for (const MovingObstacle& stranger : query.moving) {
      has_any_ = has_any_ || may_reach(stranger);
      const double soon_m = room_m(stranger) - stranger.speed_mps * to_seconds(kSoon);
      if (soon_m > least_m) continue;
      least_m = soon_m;
      nearest_ = &stranger;
    }
  }

  bool are_none() const { return !has_any_ && !nearest_; }
  /// Calls `call` with the unit vector from each stranger to the robot.
  template <typename Call>
  void for_each_offset(const Call& call) const {
    if (!has_any_) return call(offset(*nearest_));
    for (const MovingObstacle& stranger : query_.moving)
      if (may_reach(stranger)) call(offset(stranger));
  }

 private:
  double room_m(const MovingObstacle& stranger) const {
    return (query_.at_start.position_m - stranger.position_m).norm() - stranger.reach_m(stop_);
  }
  bool may_reach(const MovingObstacle& stranger) const { return !(room_m(stranger) > min_separation_m_); }
  Vec2 offset(const MovingObstacle& stranger) const {
    return (query_.at_start.position_m - stranger.position_m).stableNormalized();
  }

  const SearchQuery& query_;
  double min_separation_m_;
  Time stop_;
  bool has_any_ = false;
  const MovingObstacle* nearest_ = nullptr;
};

/// A direction, and the cosine of its largest angle to the way straight away from any stranger.
struct Direction {
  Vec2 unit{1, 0};
  double least = 1;
};

/// The direction that leads away from all strangers most directly, given one that is near it: it bisects the
/// angle between the outermost offsets.
Vec2 bisector(const Vec2& near, const NearStrangers& strangers) {
  double first_rad = 4, last_rad = -4;
  strangers.for_each_offset([&](const Vec2& offset) {
    const double angle_rad = std::atan2(near.x() * offset.y() - near.y() * offset.x(), near.dot(offset));
    first_rad = std::min(first_rad, angle_rad);
    last_rad = std::max(last_rad, angle_rad);
  });
  return rotated(near, (first_rad + last_rad) / 2);
}

}  // namespace

CreepAccelerations accelerations_away(const SearchQuery& query, double min_separation_m) {
  CreepAccelerations result;
  if (!(query.at_start.velocity_mps.norm() <= query.creep_mps)) return result;
  const NearStrangers strangers(query, min_separation_m);
  if (strangers.are_none()) return result;
  std::array<Direction, kDirections + 1> directions;
  for (int i = 0; i < kDirections; ++i)
    directions[static_cast<std::size_t>(i)].unit = rotated({1, 0}, 2 * std::numbers::pi * i / kDirections);
  const auto update = [&](Direction& direction) {
    strangers.for_each_offset(
        [&](const Vec2& offset) { direction.least = std::min(direction.least, direction.unit.dot(offset)); });
  };
  const auto regular = std::span(directions).first(kDirections);
  std::ranges::for_each(regular, update);
  // Between two strangers only a few degrees may lead away from both.
  directions.back().unit =
      bisector(std::ranges::max_element(regular, {}, &Direction::least)->unit, strangers);
  update(directions.back());
  std::ranges::sort(directions, [](const Direction& a, const Direction& b) { return a.least > b.least; });
  const double speed_mps = kSpeedFactor * query.creep_mps;
  for (const Direction& direction : directions) {
    if (!(direction.least > 0) || result.count == CreepAccelerations::kMax) break;
    result.mps2[result.count++] =
        (speed_mps * direction.unit - query.at_start.velocity_mps) / to_seconds(query.hold_time);
  }
  return result;
}

}  // namespace sidestep
