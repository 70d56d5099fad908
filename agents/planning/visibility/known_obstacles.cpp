// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/visibility/known_obstacles.hpp"

namespace sidestep {
namespace {

Box box_of(const Segment& motion) {
  return {motion.from_m.cwiseMin(motion.to_m), motion.from_m.cwiseMax(motion.to_m)};
}

}  // namespace

void KnownObstacles::clear(double radius_m) {
  radius_m_ = radius_m;
  known_.clear();
  last_blocking_ = 0;
}

void KnownObstacles::add(const Shape& shape) {
  known_.push_back({inflated(bounds(shape), radius_m_), &shape});
}

bool KnownObstacles::blocks_motion(const Known& known, const Segment& motion, const Box& box) const {
  if (!overlap(box, known.box)) return false;
  const auto* circle = std::get_if<Circle>(known.shape);
  const double reach_m = radius_m_ + (circle ? circle->radius_m : 0);
  return (circle ? squared_distance(circle->centre_m, motion) : squared_distance(motion, *known.shape)) <=
         reach_m * reach_m;
}

bool KnownObstacles::last_blocks(const Segment& motion) const {
  return last_blocking_ < known_.size() && blocks_motion(known_[last_blocking_], motion, box_of(motion));
}

bool KnownObstacles::blocks(const Segment& motion) {
  const Box box = box_of(motion);
  for (std::size_t i = 0; i < known_.size(); ++i) {
    if (!blocks_motion(known_[i], motion, box)) continue;
    last_blocking_ = i;
    return true;
  }
  return false;
}

bool KnownObstacles::covers(const Vec2& position, std::size_t first, std::size_t end) const {
  for (std::size_t i = first; i < end; ++i)
    if (overlap(known_[i].box, {position, position}) &&
        signed_distance(position, *known_[i].shape) < kCoincidence_m)
      return true;
  return false;
}

}  // namespace sidestep
