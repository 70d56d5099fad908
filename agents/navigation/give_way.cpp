// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/give_way.hpp"

#include <algorithm>
#include <utility>

namespace sidestep {
namespace {

/// Without progress for this long, a robot may be in the way of another robot.
constexpr Duration kStuckAfter{1'500'000'000};
/// Progress means coming this much nearer to the goal than ever before.
constexpr double kProgress_m = 0.1;
/// Interval between two searches, and between two checks whether the way is free.
constexpr Duration kRetryAfter{500'000'000};
/// A place is given up if the robot comes no nearer to it for this long.
constexpr Duration kUnreachableAfter{3'000'000'000};
/// After a longer time without decisions, the measurement of progress starts over.
constexpr Duration kMaxPause{1'000'000'000};
/// The first search covers places up to this distance. Each further search covers twice the distance.
constexpr double kFirstRange_m = 1;
constexpr double kLongestRange_m = 8;

}  // namespace

GiveWay::GiveWay(const GiveWayFloor& floor, const GiveWaySettings& settings)
    : settings_(settings),
      search_(floor),
      range_m_(kFirstRange_m),
      min_separation_m_(floor.min_separation_m) {}

void GiveWay::restart(Time now) {
  progress_at_ = now;
  shortest_m_ = kInfinity_m;
  way_.clear();
  yields_to_.clear();
  trips_.clear();
  unreachable_.clear();
  search_.cancel();
  range_m_ = kFirstRange_m;
}

std::optional<std::pair<RobotId, Vec2>> GiveWay::waits_for() const {
  if (way_.empty() || yields_to_.empty()) return std::nullopt;
  const auto trip = trips_.find(yields_to_.front());
  if (trip == trips_.end()) return std::nullopt;
  return std::pair(trip->first, trip->second.first);
}

bool GiveWay::track_progress(Time now, double remaining_m) {
  const bool is_new = now - called_at_ > kMaxPause || now < progress_at_;
  called_at_ = now;
  remaining_m_ = remaining_m;
  if (is_new || remaining_m < shortest_m_ - kProgress_m) {
    shortest_m_ = remaining_m;
    progress_at_ = now;
    if (way_.empty()) search_.cancel();
  }
  if (search_.is_active()) return true;
  if (way_.empty() && now - progress_at_ < kStuckAfter) return false;
  return now - checked_at_ >= kRetryAfter || now < checked_at_;
}

void GiveWay::begin_search(Time now, const Vec2& position_m, std::span<const OtherRobot> others,
                           ObstacleWorld fixed) {
  checked_at_ = now;
  searched_.clear();
  if (!way_.empty()) check_place(now, position_m, others);
  GiveWayQuery query;
  query.position_m = position_m;
  query.way = way_;
  query.range_m = range_m_;
  query.unreachable_m = unreachable_;
  for (const OtherRobot& other : others) {
    if (other.is_near && other.is_held) fixed.add(search_.disc_at(other.position_m));
    if (other.is_near) {
      query.others_m.push_back(other.position_m);
      remember_trips(other);
    }
    const bool is_passing = std::ranges::find(yields_to_, other.id) != yields_to_.end();
    if (other.has_right_of_way) searched_.push_back(other.id);
    if (!other.has_right_of_way && !is_passing && !other.returns) continue;
    auto& trips = other.returns ? query.returns : query.trips;
    const auto [first, last] = trips_.equal_range(other.id);
    for (auto trip = first; trip != last; ++trip) trips.push_back(trip->second);
  }
  search_.begin(std::move(query), std::move(fixed));
}

void GiveWay::check_place(Time now, const Vec2& position_m, std::span<const OtherRobot> others) {
  const Vec2 place = way_.back();
  const bool is_covered = std::ranges::any_of(others, [&](const OtherRobot& other) {
    return other.is_near && (other.position_m - place).norm() < min_separation_m_;
  });
  const double distance_m = (position_m - place).norm();
  if (distance_m < nearest_m_ - kProgress_m / 2 || distance_m < kProgress_m) {
    nearest_m_ = distance_m;
    nearer_at_ = now;
  }
  const bool is_unreachable = now - nearer_at_ >= kUnreachableAfter;
  if (is_unreachable) unreachable_.push_back(place);
  if (is_covered || is_unreachable) way_.clear();
}

void GiveWay::remember_trips(const OtherRobot& other) {
  trips_.erase(other.id);
  for (const std::optional<Vec2>& goal : other.goals_m)
    if (goal && (*goal - other.position_m).norm() >= kProgress_m)
      trips_.emplace(other.id, Trip(other.position_m, *goal));
}

void GiveWay::search(Time now, Rng& rng) {
  has_given_up_ = false;
  search_.step(rng);
  if (search_.is_active()) return;
  if (!way_.empty()) {
    has_given_up_ = search_.is_in_the_way() && now - began_at_ >= settings_.give_up_after;
    if (!search_.is_in_the_way() || has_given_up_) restart(now);
    return;
  }
  if (!search_.is_in_the_way()) {
    range_m_ = kFirstRange_m;
    shortest_m_ = remaining_m_;
    yields_to_.clear();
    unreachable_.clear();
    return;
  }
  way_ = search_.way();
  began_at_ = nearer_at_ = now;
  nearest_m_ = kInfinity_m;
  if (way_.empty())
    range_m_ = std::min(2 * range_m_, kLongestRange_m);
  else
    yields_to_ = searched_;
}

}  // namespace sidestep
