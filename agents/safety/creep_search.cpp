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
constexpr std::size_t kBest = 16;
/// A robot that cannot move although strangers need at least this long to reach it is not held up by them.
constexpr Duration kSoon{50'000'000};
/// A creeping robot stops within this time.
constexpr Duration kCreepingStop{20'000'000};
/// The speed is lower than permitted by this factor, so that rounding does not exceed the limit.
constexpr double kSpeedFactor = 0.99;

/// Unit vectors to the robot from the strangers that may reach it before it stops from creeping. If there are
/// none, from the nearest stranger that may reach it soon: then faster motions may be unsafe too.
std::vector<Vec2> find_offsets(const SearchQuery& query, double min_separation_m) {
  std::vector<Vec2> offsets;
  std::optional<Vec2> nearest;
  double least_m = min_separation_m;
  const Time stop = query.start + query.hold_time + kCreepingStop;
  for (const MovingObstacle& stranger : query.moving) {
    const Vec2 offset = query.at_start.position_m - stranger.position_m;
    const double room_m = offset.norm() - stranger.reach_m(stop);
    if (!(room_m > min_separation_m)) offsets.push_back(offset.stableNormalized());
    const double soon_m = room_m - stranger.speed_mps * to_seconds(kSoon);
    if (soon_m > least_m) continue;
    least_m = soon_m;
    nearest = offset.stableNormalized();
  }
  if (offsets.empty() && nearest) offsets.push_back(*nearest);
  return offsets;
}

}  // namespace

std::vector<Vec2> accelerations_away(const SearchQuery& query, double min_separation_m) {
  if (!(query.at_start.velocity_mps.norm() <= query.creep_mps)) return {};
  const std::vector<Vec2> offsets = find_offsets(query, min_separation_m);
  if (offsets.empty()) return {};
  std::vector<std::pair<double, Vec2>> directions;
  const auto add = [&](const Vec2& direction) {
    double least = 1;
    for (const Vec2& offset : offsets) least = std::min(least, direction.dot(offset));
    if (least > 0) directions.emplace_back(least, direction);
  };
  for (int i = 0; i < kDirections; ++i) add(rotated({1, 0}, 2 * std::numbers::pi * i / kDirections));
  // Between two strangers only a few degrees may lead away from both.
  for (const Vec2& first : offsets) {
    for (const Vec2& second : offsets) add((first + second).stableNormalized());
  }
  std::ranges::stable_sort(directions, [](const auto& a, const auto& b) { return a.first > b.first; });
  directions.resize(std::min(directions.size(), kBest));
  std::vector<Vec2> accelerations;
  const double speed_mps = kSpeedFactor * query.creep_mps;
  for (const auto& [least, direction] : directions)
    accelerations.emplace_back((speed_mps * direction - query.at_start.velocity_mps) /
                               to_seconds(query.hold_time));
  return accelerations;
}

}  // namespace sidestep
