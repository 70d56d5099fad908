// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/bubble_band/bubble_band.hpp"

#include <algorithm>
#include <stdexcept>

namespace sidestep {
namespace {

// The values are from Philippsen, EPFL thesis 3146, ch. 3.
// Passages between bubbles, in diameters of the robot.
constexpr double kRemoveAt = 1.8;     ///< removes a bubble if its neighbours leave at least this passage
constexpr double kInsertBelow = 1.2;  ///< inserts a bubble where the passage is smaller
constexpr double kBrokenBelow = 1;    ///< the band is broken where the passage is smaller
constexpr double kMaxBubble_m = 2;    ///< maximum radius of bubbles far from obstacles
constexpr double kMinSpacing_radii = 0.125;  ///< minimum distance between centres of inserted bubbles
constexpr double kCrowded_radii = 1;         ///< if a bubble's neighbours are closer, it may be removed
constexpr std::size_t kMaxBubbles = 400;
// Path lengths at which obstacles near the robot begin to be ignored, and from which they are fully ignored.
constexpr double kMaskedFrom_m = 2, kMaskedFullyFrom_m = 10;

void require(bool condition, const char* what) {
  if (!condition) throw std::invalid_argument(what);
}

}  // namespace

BubbleBand::BubbleBand(double robot_radius_m, const BubbleBandSettings& settings)
    : robot_radius_m_(robot_radius_m), settings_(settings) {
  require(robot_radius_m > 0 && robot_radius_m <= kMaxBubble_m,
          "a bubble band's robot radius has to be positive, and at most that of a bubble");
  for (std::vector<Bubble>* bubbles : {&bubbles_, &kept_, &pending_}) bubbles->reserve(2 * kMaxBubbles);
}

double BubbleBand::masked_m(double path_m) const {
  constexpr double kRange_m = kMaskedFullyFrom_m - kMaskedFrom_m;
  return settings_.max_masked_m * std::clamp((path_m - kMaskedFrom_m) / kRange_m, 0.0, 1.0);
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
  bubble.radius_m = std::clamp(found.distance_m, 0.0, kMaxBubble_m);
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
  const double needed_m = kBrokenBelow * 2 * robot_radius_m_;
  // Each bubble takes the previous bubble's new position into account, so neighbours do not overshoot
  // together.
  for (std::size_t i = 1; i + 1 < bubbles_.size(); ++i) {
    const Bubble &before = bubbles_[i - 1], &after = bubbles_[i + 1];
    Bubble& bubble = bubbles_[i];
    const double least_before_m = std::min(needed_m, passage_width_m(before, bubble));
    const double least_after_m = std::min(needed_m, passage_width_m(bubble, after));
    Vec2 move = displacement_m(before.centre_m, bubble, after.centre_m, robot_radius_m_);
    for (int attempt = 0; attempt < kAttempts; ++attempt, move /= 2) {
      Bubble moved = bubble;
      moved.centre_m += move;
      measure(moved, free);
      if (passage_width_m(before, moved) < least_before_m || passage_width_m(moved, after) < least_after_m)
        continue;
      bubble = moved;
      break;
    }
  }
}

bool BubbleBand::is_superfluous(const Bubble& before, const Bubble& bubble, const Bubble& after) const {
  const double without_m = passage_width_m(before, after), diameter_m = 2 * robot_radius_m_;
  if (without_m >= kRemoveAt * diameter_m) return true;
  const double apart_m = (before.centre_m - after.centre_m).norm();
  if (without_m >= kInsertBelow * diameter_m) return apart_m <= kCrowded_radii * robot_radius_m_;
  // In narrow passages a bubble is only removed if its neighbours are so close together that insertion would
  // not put it back.
  return apart_m < 2 * kMinSpacing_radii * robot_radius_m_ &&
         without_m >= std::min(passage_width_m(before, bubble), passage_width_m(bubble, after));
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
  const double wanted_m = kInsertBelow * 2 * robot_radius_m_;
  const double closest_m = kMinSpacing_radii * robot_radius_m_;
  pending_.clear();
  pending_.push_back(next);
  while (!pending_.empty()) {
    const Bubble &from = kept_.back(), &to = pending_.back();
    const double leg_m = (to.centre_m - from.centre_m).norm();
    const bool has_room = kept_.size() + pending_.size() < kMaxBubbles;
    if (passage_width_m(from, to) >= wanted_m || leg_m < 2 * closest_m || !has_room) {
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
    if (passage_width_m(bubbles_[i - 1], bubble) < kBrokenBelow * 2 * robot_radius_m_) is_broken_ = true;
  }
}

}  // namespace sidestep
