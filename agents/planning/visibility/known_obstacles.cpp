// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/visibility/known_obstacles.hpp"

namespace sidestep {
namespace {

Box box_of(const Segment& way) { return {way.from_m.cwiseMin(way.to_m), way.from_m.cwiseMax(way.to_m)}; }

}  // namespace

void KnownObstacles::clear(double radius_m) {
  radius_m_ = radius_m;
  known_.clear();
  last_ = 0;
}

void KnownObstacles::add(const Shape& shape) { known_.push_back({grown(bounds(shape), radius_m_), &shape}); }

bool KnownObstacles::stops(const Known& known, const Segment& way, const Box& box) const {
  if (!overlap(box, known.box)) return false;
  const auto* circle = std::get_if<Circle>(known.shape);
  const double reach_m = radius_m_ + (circle ? circle->radius_m : 0);
  return (circle ? squared_distance(circle->centre_m, way) : squared_distance(way, *known.shape)) <=
         reach_m * reach_m;
}

bool KnownObstacles::stop_again(const Segment& way) const {
  return last_ < known_.size() && stops(known_[last_], way, box_of(way));
}

bool KnownObstacles::stop(const Segment& way) {
  const Box box = box_of(way);
  for (std::size_t i = 0; i < known_.size(); ++i) {
    if (!stops(known_[i], way, box)) continue;
    last_ = i;
    return true;
  }
  return false;
}

bool KnownObstacles::hold(const Vec2& place, std::size_t first, std::size_t end) const {
  for (std::size_t i = first; i < end; ++i)
    if (overlap(known_[i].box, {place, place}) && signed_distance(place, *known_[i].shape) < kTouching_m)
      return true;
  return false;
}

}  // namespace sidestep
