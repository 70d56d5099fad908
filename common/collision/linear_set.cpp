// SPDX-License-Identifier: Apache-2.0
#include "common/collision/linear_set.hpp"

#include <limits>

namespace sidestep {

using collision::BoxBlock;
using collision::CircleBlock;
using collision::kLanes;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kEmptyLane_m = 1e18f;

void copy_lane(const CircleBlock& from, std::size_t from_lane, CircleBlock& to, std::size_t to_lane) {
  to.x_m[to_lane] = from.x_m[from_lane];
  to.y_m[to_lane] = from.y_m[from_lane];
  to.radius_m[to_lane] = from.radius_m[from_lane];
}

void copy_lane(const BoxBlock& from, std::size_t from_lane, BoxBlock& to, std::size_t to_lane) {
  to.min_x_m[to_lane] = from.min_x_m[from_lane];
  to.min_y_m[to_lane] = from.min_y_m[from_lane];
  to.max_x_m[to_lane] = from.max_x_m[from_lane];
  to.max_y_m[to_lane] = from.max_y_m[from_lane];
}

}  // namespace

LinearSet::LinearSet(const ShapeStore& store) : origin_m_(store.origin_m()) {
  for (const Slot slot : store.slots()) add(slot, store.shape(slot));
}

void LinearSet::add(Slot slot, const Shape& shape) {
  const bool is_circle = std::holds_alternative<Circle>(shape);
  auto& slots = is_circle ? circle_slots_ : box_slots_;
  const Location location{static_cast<std::uint32_t>(slots.size()), is_circle};
  if (location.lane % kLanes == 0) {
    if (is_circle)
      circles_.emplace_back();
    else
      boxes_.emplace_back();
    for (std::uint32_t lane = location.lane; lane < location.lane + kLanes; ++lane) clear({lane, is_circle});
  }
  slots.push_back(slot);
  if (slot >= locations_.size()) locations_.resize(slot + 1);
  locations_[slot] = location;
  put(location, shape);
}

void LinearSet::replace(Slot slot, const Shape& shape) { put(locations_[slot], shape); }

void LinearSet::remove(Slot slot) {
  const Location location = locations_[slot];
  auto& slots = location.is_circle ? circle_slots_ : box_slots_;
  const Location last{static_cast<std::uint32_t>(slots.size() - 1), location.is_circle};
  const std::size_t block = location.lane / kLanes, lane = location.lane % kLanes,
                    last_lane = last.lane % kLanes;
  if (location.is_circle)
    copy_lane(circles_.back(), last_lane, circles_[block], lane);
  else
    copy_lane(boxes_.back(), last_lane, boxes_[block], lane);
  clear(last);
  slots[location.lane] = slots.back();
  locations_[slots.back()] = location;
  slots.pop_back();
  if (last_lane != 0) return;
  if (location.is_circle)
    circles_.pop_back();
  else
    boxes_.pop_back();
}

void LinearSet::put(Location location, const Shape& shape) {
  const std::size_t block = location.lane / kLanes, lane = location.lane % kLanes;
  if (location.is_circle) {
    const auto& circle = std::get<Circle>(shape);
    const Vec2 centre = circle.centre_m - origin_m_;
    circles_[block].x_m[lane] = static_cast<float>(centre.x());
    circles_[block].y_m[lane] = static_cast<float>(centre.y());
    circles_[block].radius_m[lane] = static_cast<float>(circle.radius_m);
  } else {
    const Box box = bounds(shape);
    const Vec2 low = box.min_m - origin_m_, high = box.max_m - origin_m_;
    boxes_[block].min_x_m[lane] = rounded_down(low.x());
    boxes_[block].min_y_m[lane] = rounded_down(low.y());
    boxes_[block].max_x_m[lane] = rounded_up(high.x());
    boxes_[block].max_y_m[lane] = rounded_up(high.y());
  }
}

void LinearSet::clear(Location location) {
  const std::size_t block = location.lane / kLanes, lane = location.lane % kLanes;
  if (location.is_circle) {
    circles_[block].x_m[lane] = circles_[block].y_m[lane] = kEmptyLane_m;
    circles_[block].radius_m[lane] = 0;
  } else {
    boxes_[block].min_x_m[lane] = boxes_[block].min_y_m[lane] = kNan;
    boxes_[block].max_x_m[lane] = boxes_[block].max_y_m[lane] = kNan;
  }
}

}  // namespace sidestep
