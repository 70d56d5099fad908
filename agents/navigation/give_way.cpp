// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/give_way.hpp"

#include <algorithm>
#include <utility>

namespace sidestep {

GiveWay::GiveWay(const GiveWayFloor& floor, const GiveWaySettings& settings)
    : settings_(settings), search_(floor), range_m_(settings.first_range_m) {}

void GiveWay::restart(Time now) {
  anchored_at_ = now;
  way_.clear();
  yields_to_.clear();
  search_.cancel();
  range_m_ = settings_.first_range_m;
}

bool GiveWay::is_due(Time now, const Vec2& position_m) {
  const bool is_new = now - called_at_ > settings_.max_pause;
  called_at_ = now;
  if (is_new || (position_m - anchor_m_).norm() > settings_.progress_m || now < anchored_at_) {
    anchor_m_ = position_m;
    anchored_at_ = now;
    if (way_.empty()) search_.cancel();
  }
  if (search_.is_active()) return true;
  if (way_.empty() && now - anchored_at_ < settings_.stuck_after) return false;
  return now - checked_at_ >= settings_.retry_after || now < checked_at_;
}

void GiveWay::begin_search(Time now, const Vec2& position_m, std::span<const OtherRobot> others,
                           ObstacleWorld fixed) {
  checked_at_ = now;
  searched_.clear();
  GiveWayQuery query;
  query.position_m = position_m;
  query.way = way_;
  query.range_m = range_m_;
  for (const OtherRobot& other : others) {
    query.others_m.push_back(other.position_m);
    const bool is_passing = std::ranges::find(yields_to_, other.id) != yields_to_.end();
    if (other.has_right_of_way) searched_.push_back(other.id);
    if (!other.has_right_of_way && !is_passing) continue;
    for (const std::optional<Vec2>& goal : other.goals_m)
      if (goal && (*goal - other.position_m).norm() >= settings_.progress_m)
        query.trips.emplace_back(other.position_m, *goal);
  }
  search_.begin(std::move(query), std::move(fixed));
}

void GiveWay::search(Time now, Rng& rng) {
  search_.step(rng);
  if (search_.is_active()) return;
  if (!way_.empty()) {
    if (!search_.is_in_the_way() || now - began_at_ >= settings_.give_up_after) restart(now);
    return;
  }
  if (!search_.is_in_the_way()) {
    range_m_ = settings_.first_range_m;
    return;
  }
  way_ = search_.way();
  began_at_ = now;
  if (way_.empty())
    range_m_ = std::min(2 * range_m_, settings_.longest_range_m);
  else
    yields_to_ = searched_;
}

}  // namespace sidestep
