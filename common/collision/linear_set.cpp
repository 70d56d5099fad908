// SPDX-License-Identifier: Apache-2.0
#include "common/collision/linear_set.hpp"

#include <algorithm>
#include <bit>
#include <limits>

namespace sidestep {

using collision::Answer;
using collision::BoxBlock;
using collision::CircleBlock;
using collision::kLanes;

namespace {

constexpr double kRounding = 0x1p-24;
constexpr float kInfinite = std::numeric_limits<float>::infinity();
constexpr float kNowhere_m = 1e18f;      // where circles are that do not count
constexpr double kFarthest_m = 1e15;     // up to which nothing in single precision overflows
constexpr double kShortest2_m2 = 1e-24;  // a shorter way is none

float rounded_down(double value) { return std::nextafter(static_cast<float>(value), -kInfinite); }
float rounded_up(double value) { return std::nextafter(static_cast<float>(value), kInfinite); }

// The error of a position is at most 8 roundings of what is farthest from the origin: those of two positions,
// of the difference, of the foot's parameter and of its product. So with a reach R and such an error e the
// squared distance is wrong by at most 2 R e + e^2, near the reach.
double doubt(double farthest_m, double reach_m) {
  const double error_m = 32 * kRounding * (farthest_m + reach_m);
  return 2 * error_m * (reach_m + 2 * error_m);
}

}  // namespace

LinearSet::LinearSet(const Bodies& bodies, const collision::Kernels& kernels)
    : kernels_(&kernels), origin_m_(0, 0) {
  if (!bodies.slots().empty()) {
    Box box = bounds(bodies.shape(bodies.slots().front()));
    for (const Slot slot : bodies.slots()) box = around(box, bounds(bodies.shape(slot)));
    origin_m_ = 0.5 * box.min_m + 0.5 * box.max_m;
  }
  for (const Slot slot : bodies.slots()) add(slot, bodies.shape(slot));
}

void LinearSet::add(Slot slot, const Shape& shape) {
  const bool is_circle = std::holds_alternative<Circle>(shape);
  auto& slots = is_circle ? circle_slots_ : box_slots_;
  const Place place{static_cast<std::uint32_t>(slots.size()), is_circle};
  if (place.lane % kLanes == 0) {
    if (is_circle)
      circles_.emplace_back();
    else
      boxes_.emplace_back();
    for (std::uint32_t lane = place.lane; lane < place.lane + kLanes; ++lane) clear({lane, is_circle});
  }
  slots.push_back(slot);
  if (slot >= places_.size()) places_.resize(slot + 1);
  places_[slot] = place;
  put(place, shape);
}

void LinearSet::replace(Slot slot, const Shape& shape) {
  if (std::holds_alternative<Circle>(shape) == places_[slot].is_circle) return put(places_[slot], shape);
  remove(slot);
  add(slot, shape);
}

void LinearSet::remove(Slot slot) {
  const Place place = places_[slot];
  auto& slots = place.is_circle ? circle_slots_ : box_slots_;
  const Place last{static_cast<std::uint32_t>(slots.size() - 1), place.is_circle};
  const std::size_t to = place.lane / kLanes, at = place.lane % kLanes;
  const std::size_t from = last.lane / kLanes, last_at = last.lane % kLanes;
  if (place.is_circle) {
    circles_[to].x_m[at] = circles_[from].x_m[last_at];
    circles_[to].y_m[at] = circles_[from].y_m[last_at];
    circles_[to].radius_m[at] = circles_[from].radius_m[last_at];
  } else {
    boxes_[to].min_x_m[at] = boxes_[from].min_x_m[last_at];
    boxes_[to].min_y_m[at] = boxes_[from].min_y_m[last_at];
    boxes_[to].max_x_m[at] = boxes_[from].max_x_m[last_at];
    boxes_[to].max_y_m[at] = boxes_[from].max_y_m[last_at];
  }
  clear(last);
  slots[place.lane] = slots.back();
  places_[slots.back()] = place;
  slots.pop_back();
  if (last_at != 0) return;
  if (place.is_circle)
    circles_.pop_back();
  else
    boxes_.pop_back();
}

void LinearSet::put(Place place, const Shape& shape) {
  const Box box = bounds(shape);
  const Vec2 low = box.min_m - origin_m_, high = box.max_m - origin_m_;
  const std::size_t block = place.lane / kLanes, at = place.lane % kLanes;
  if (place.is_circle) {
    const auto& circle = std::get<Circle>(shape);
    const Vec2 centre = circle.centre_m - origin_m_;
    circles_[block].x_m[at] = static_cast<float>(centre.x());
    circles_[block].y_m[at] = static_cast<float>(centre.y());
    circles_[block].radius_m[at] = static_cast<float>(circle.radius_m);
    farthest_m_ = std::max(farthest_m_, centre.cwiseAbs().maxCoeff());
    largest_radius_m_ = std::max(largest_radius_m_, circle.radius_m);
  } else {
    boxes_[block].min_x_m[at] = rounded_down(low.x());
    boxes_[block].min_y_m[at] = rounded_down(low.y());
    boxes_[block].max_x_m[at] = rounded_up(high.x());
    boxes_[block].max_y_m[at] = rounded_up(high.y());
  }
}

void LinearSet::clear(Place place) {
  const std::size_t block = place.lane / kLanes, at = place.lane % kLanes;
  if (place.is_circle) {
    circles_[block].x_m[at] = circles_[block].y_m[at] = kNowhere_m;
    circles_[block].radius_m[at] = 0;
  } else {
    boxes_[block].min_x_m[at] = boxes_[block].min_y_m[at] = kInfinite;
    boxes_[block].max_x_m[at] = boxes_[block].max_y_m[at] = -kInfinite;
  }
}

bool LinearSet::touches(const Sweep& sweep, const Bodies& bodies) const {
  const Vec2 from = sweep.from_m - origin_m_, to = from + sweep.way_m;
  const double farthest_m =
      std::max(farthest_m_, std::max(from.cwiseAbs().maxCoeff(), to.cwiseAbs().maxCoeff()));
  const double reach_m = sweep.radius_m + largest_radius_m_;
  if (!(farthest_m + reach_m <= kFarthest_m)) return touches_exactly(sweep, bodies);
  const double per_length2 = sweep.way_m.squaredNorm() < kShortest2_m2 ? 0 : sweep.per_length2;
  const collision::SweepRow row{static_cast<float>(from.x()),
                                static_cast<float>(from.y()),
                                static_cast<float>(sweep.way_m.x()),
                                static_cast<float>(sweep.way_m.y()),
                                static_cast<float>(sweep.way_m.x() * per_length2),
                                static_cast<float>(sweep.way_m.y() * per_length2),
                                static_cast<float>(sweep.radius_m),
                                static_cast<float>(doubt(farthest_m, reach_m))};
  const Answer answer = kernels_->sweep(circles_.data(), circles_.size(), row);
  if (answer == Answer::kTouches) return true;
  if (answer == Answer::kInDoubt) return touches_exactly(sweep, bodies);
  return !boxes_.empty() && touches_others(sweep, bodies);
}

bool LinearSet::touches_others(const Sweep& sweep, const Bodies& bodies) const {
  const Box box = sweep.bounds();
  const Vec2 low = box.min_m - origin_m_, high = box.max_m - origin_m_;
  const collision::BoxRow row{rounded_down(low.x()), rounded_down(low.y()), rounded_up(high.x()),
                              rounded_up(high.y())};
  unsigned lanes = 0;
  for (std::size_t block = 0;; ++block) {
    block = kernels_->next_overlap(boxes_.data(), block, boxes_.size(), row, &lanes);
    if (block == boxes_.size()) return false;
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto lane = block * kLanes + static_cast<std::size_t>(std::countr_zero(lanes));
      if (bodies.touches(box_slots_[lane], sweep)) return true;
    }
  }
}

bool LinearSet::touches_exactly(const Sweep& sweep, const Bodies& bodies) const {
  return std::any_of(bodies.slots().begin(), bodies.slots().end(),
                     [&](Slot slot) { return bodies.touches(slot, sweep); });
}

}  // namespace sidestep
