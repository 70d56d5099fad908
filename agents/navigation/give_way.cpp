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
/// Robots nearer to their goals have no trip before them.
constexpr double kShortestTrip_m = 0.005;
/// Interval between two searches, and between two checks whether the way is free.
constexpr Duration kRetryAfter{500'000'000};
/// A place is given up if the robot comes no nearer to it for this long.
constexpr Duration kUnreachableAfter{3'000'000'000};
/// After a longer time without decisions, the measurement of progress starts over.
constexpr Duration kMaxPause{1'000'000'000};
/// The first search covers places up to this distance. Each further search covers twice the distance.
constexpr double kFirstRange_m = 1;
constexpr double kLongestRange_m = 8;
/// If the others need the robot's place, they are getting ahead, and the robot gives way for longer. But they
/// may also push to and fro, so this happens only so often.
constexpr int kMaxMoves = 5;

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
  is_replacing_ = false;
  moves_ = 0;
  yields_to_.clear();
  trips_.clear();
  unreachable_.clear();
  search_.cancel();
  range_m_ = kFirstRange_m;
  passes_waiting_ = false;
  is_to_return_ = true;
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
                           ObstacleWorld fixed, const std::optional<Vec2>& home_m) {
  checked_at_ = now;
  searched_.clear();
  has_waiting_ = std::ranges::any_of(others, &OtherRobot::waits);
  if (!way_.empty() && !is_replacing_) check_place(now, position_m, others);
  GiveWayQuery query;
  query.position_m = searched_from_m_ = position_m;
  if (!is_replacing_) query.way = way_;
  query.left_m = left_m_;
  query.range_m = range_m_;
  query.unreachable_m = unreachable_;
  if (is_to_return_) query.home_m = home_m;
  comes_back_ = home_m.has_value();
  for (const OtherRobot& other : others) {
    if (other.is_near && other.is_held) fixed.add(search_.disc_at(other.position_m));
    if (other.is_near) {
      query.others_m.push_back(other.position_m);
      if (other.waits && passes_waiting_) query.passable_m.push_back(other.position_m);
      remember_trips(other);
    }
    const bool is_passing = std::ranges::find(yields_to_, other.id) != yields_to_.end();
    if (other.has_right_of_way) {
      searched_.push_back(other.id);
      if (other.end_m) query.ends_m.push_back(*other.end_m);
    }
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
    return other.is_near && other.rests && (other.position_m - place).norm() < min_separation_m_;
  });
  const double distance_m = (position_m - place).norm();
  if (distance_m < nearest_m_ - kProgress_m / 2 || distance_m < kProgress_m) {
    nearest_m_ = distance_m;
    nearer_at_ = now;
  }
  const bool is_unreachable = now - nearer_at_ >= kUnreachableAfter;
  if (is_unreachable) unreachable_.push_back(place);
  is_replacing_ = is_covered || is_unreachable;
}

void GiveWay::remember_trips(const OtherRobot& other) {
  trips_.erase(other.id);
  for (const std::optional<Vec2>& goal : other.goals_m)
    if (goal && (*goal - other.position_m).norm() >= kShortestTrip_m)
      trips_.emplace(other.id, Trip(other.position_m, *goal));
}

void GiveWay::search(Time now, Rng& rng) {
  has_given_up_ = false;
  search_.step(rng);
  if (search_.is_active()) return;
  if (!way_.empty() && !is_replacing_) return check_way(now);
  if (search_.is_in_the_way() && search_.way().empty()) {
    has_given_up_ = is_replacing_ && now - began_at_ >= settings_.give_up_after;
    return has_given_up_ ? restart(now) : widen_search();
  }
  range_m_ = kFirstRange_m;
  passes_waiting_ = false;
  is_to_return_ = true;
  if (search_.is_in_the_way()) {
    if (!is_replacing_) {
      left_m_ = search_.way().front();
      began_at_ = now;
    }
    way_ = search_.way();
    nearer_at_ = now;
    nearest_m_ = kInfinity_m;
    yields_to_ = searched_;
  } else if (is_replacing_) {
    way_ = {searched_from_m_};  // it is in nobody's way here
    nearer_at_ = now;
  } else {
    shortest_m_ = remaining_m_;
    yields_to_.clear();
    unreachable_.clear();
  }
  is_replacing_ = false;
}

void GiveWay::check_way(Time now) {
  has_given_up_ = search_.is_in_the_way() && now - began_at_ >= settings_.give_up_after;
  if (!search_.is_in_the_way() || has_given_up_) return restart(now);
  // The others have moved, and may need this place now.
  is_replacing_ = search_.is_place_on_route() && nearest_m_ < kProgress_m;
  if (is_replacing_ && ++moves_ <= kMaxMoves) began_at_ = now;
}

void GiveWay::widen_search() {
  passes_waiting_ = has_waiting_ && !passes_waiting_;
  if (passes_waiting_) return;
  if (range_m_ < kLongestRange_m) {
    range_m_ = std::min(2 * range_m_, kLongestRange_m);
  } else if (comes_back_ && std::exchange(is_to_return_, false)) {
    range_m_ = kFirstRange_m;
  }
}

}  // namespace sidestep
