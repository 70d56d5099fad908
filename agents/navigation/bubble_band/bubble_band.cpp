// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/bubble_band/bubble_band.hpp"

#include <algorithm>
#include <stdexcept>

namespace sidestep {
namespace {

void require(bool condition, const char* what) {
  if (!condition) throw std::invalid_argument(what);
}

void check(double robot_radius_m, const BubbleBandSettings& settings) {
  require(robot_radius_m > 0 && std::isfinite(robot_radius_m),
          "a bubble band's robot radius has to be positive");
  const BubbleForces& forces = settings.forces;
  require(forces.internal_m >= 0 && forces.external >= 0 && forces.reach_radii > 0,
          "forces on bubbles must not be negative");
  require(forces.max_step > 0 && forces.max_step < 1, "a bubble has to move less than its radius");
  require(settings.broken_below > 0 && settings.broken_below <= settings.insert_below &&
              settings.insert_below < settings.remove_at,
          "passages of a bubble band: 0 < broken_below <= insert_below < remove_at");
  require(settings.max_radius_m >= robot_radius_m && std::isfinite(settings.max_radius_m),
          "bubbles have to be as large as the robot");
  require(settings.min_spacing > 0 && settings.crowded >= 0 && settings.max_bubbles >= 2,
          "a bubble band needs a positive spacing and two bubbles");
  require(settings.max_masked_m >= 0 && settings.masked_from_m >= 0 &&
              settings.masked_fully_from_m > settings.masked_from_m,
          "masked distances of a bubble band have to grow with the path length");
}

}  // namespace

BubbleBand::BubbleBand(double robot_radius_m, const BubbleBandSettings& settings)
    : robot_radius_m_(robot_radius_m), settings_(settings) {
  check(robot_radius_m, settings);
  for (std::vector<Bubble>* bubbles : {&bubbles_, &kept_, &pending_})
    bubbles->reserve(2 * settings.max_bubbles);
}

double BubbleBand::masked_m(double path_m) const {
  const double range_m = settings_.masked_fully_from_m - settings_.masked_from_m;
  return settings_.max_masked_m * std::clamp((path_m - settings_.masked_from_m) / range_m, 0.0, 1.0);
}

Vec2 BubbleBand::position_m(double ahead_m) const {
  for (std::size_t i = 1; i < bubbles_.size(); ++i) {
    const Bubble &from = bubbles_[i - 1], &to = bubbles_[i];
    if (to.path_m < ahead_m) continue;
    const double length = to.path_m - from.path_m;
    const double fraction = length > 0 ? std::max(0.0, ahead_m - from.path_m) / length : 0;
    return from.centre_m + fraction * (to.centre_m - from.centre_m);
  }
  return bubbles_.back().centre_m;
}

void BubbleBand::begin(std::span<const Vec2> path_m) {
  require(!path_m.empty(), "a bubble band needs a path");
  require(std::ranges::all_of(path_m, [](const Vec2& p) { return p.allFinite(); }),
          "the path of a bubble band has to be finite");
  bubbles_.clear();
  for (const Vec2& point : path_m) bubbles_.push_back({point, 0, {0, 0}, 0});
  if (bubbles_.size() == 1) bubbles_.push_back(bubbles_[0]);
}

void BubbleBand::measure(Bubble& bubble, const Query& free) const {
  const FreeDistance found = free(bubble.centre_m, masked_m(bubble.path_m));
  bubble.radius_m = std::clamp(found.distance_m, 0.0, settings_.max_radius_m);
  bubble.away = found.away;
}

void BubbleBand::measure_all(const Query& free) {
  for (std::size_t i = 0; i < bubbles_.size(); ++i) {
    const double leg_m = i == 0 ? 0 : (bubbles_[i].centre_m - bubbles_[i - 1].centre_m).norm();
    bubbles_[i].path_m = i == 0 ? 0 : bubbles_[i - 1].path_m + leg_m;
    measure(bubbles_[i], free);
  }
}

void BubbleBand::follow(const Vec2& robot_m) {
  require(robot_m.allFinite(), "the robot's position has to be finite");
  require(!bubbles_.empty(), "a bubble band has to be started before it is updated");
  bubbles_.front().centre_m = robot_m;
}

void BubbleBand::step(const Query& free) {
  constexpr int kAttempts = 3;
  const double needed_m = settings_.broken_below * 2 * robot_radius_m_;
  // Each bubble takes into account where the previous one has moved, so that neighbours do not overshoot
  // together.
  for (std::size_t i = 1; i + 1 < bubbles_.size(); ++i) {
    const Bubble &before = bubbles_[i - 1], &after = bubbles_[i + 1];
    Bubble& bubble = bubbles_[i];
    const double least_before_m = std::min(needed_m, passage_m(before, bubble));
    const double least_after_m = std::min(needed_m, passage_m(bubble, after));
    Vec2 move = displacement_m(before.centre_m, bubble, after.centre_m, robot_radius_m_, settings_.forces);
    for (int attempt = 0; attempt < kAttempts; ++attempt, move /= 2) {
      Bubble moved = bubble;
      moved.centre_m += move;
      measure(moved, free);
      if (passage_m(before, moved) < least_before_m || passage_m(moved, after) < least_after_m) continue;
      bubble = moved;
      break;
    }
  }
}

bool BubbleBand::is_superfluous(const Bubble& before, const Bubble& bubble, const Bubble& after) const {
  const double without_m = passage_m(before, after), diameter_m = 2 * robot_radius_m_;
  if (without_m >= settings_.remove_at * diameter_m) return true;
  const double apart_m = (before.centre_m - after.centre_m).norm();
  if (without_m >= settings_.insert_below * diameter_m) return apart_m <= settings_.crowded * robot_radius_m_;
  // In narrow passages a bubble is only removed if its neighbours are so close together that insertion would
  // not put it back.
  return apart_m < 2 * settings_.min_spacing * robot_radius_m_ &&
         without_m >= std::min(passage_m(before, bubble), passage_m(bubble, after));
}

void BubbleBand::remove_superfluous() {
  kept_.clear();
  kept_.push_back(bubbles_.front());
  for (std::size_t i = 1; i < bubbles_.size(); ++i) {
    const bool is_last = i + 1 == bubbles_.size();
    if (is_last || !is_superfluous(kept_.back(), bubbles_[i], bubbles_[i + 1])) kept_.push_back(bubbles_[i]);
  }
  std::swap(bubbles_, kept_);
}

void BubbleBand::insert_before(const Bubble& next, const Query& free) {
  const double wanted_m = settings_.insert_below * 2 * robot_radius_m_;
  const double closest_m = settings_.min_spacing * robot_radius_m_;
  pending_.clear();
  pending_.push_back(next);
  while (!pending_.empty()) {
    const Bubble &from = kept_.back(), &to = pending_.back();
    const double leg_m = (to.centre_m - from.centre_m).norm();
    const bool has_room = kept_.size() + pending_.size() < settings_.max_bubbles;
    if (passage_m(from, to) >= wanted_m || leg_m < 2 * closest_m || !has_room) {
      kept_.push_back(to);
      pending_.pop_back();
      continue;
    }
    Bubble middle{(from.centre_m + to.centre_m) / 2, 0, {0, 0}, from.path_m + leg_m / 2};
    measure(middle, free);
    pending_.push_back(middle);
  }
}

void BubbleBand::fit(const Query& free) {
  remove_superfluous();
  kept_.clear();
  kept_.push_back(bubbles_.front());
  for (std::size_t i = 1; i < bubbles_.size(); ++i) insert_before(bubbles_[i], free);
  std::swap(bubbles_, kept_);
  is_broken_ = false;
  for (std::size_t i = 1; i < bubbles_.size(); ++i) {
    Bubble& bubble = bubbles_[i];
    bubble.path_m = bubbles_[i - 1].path_m + (bubble.centre_m - bubbles_[i - 1].centre_m).norm();
    if (passage_m(bubbles_[i - 1], bubble) < settings_.broken_below * 2 * robot_radius_m_) is_broken_ = true;
  }
}

}  // namespace sidestep
