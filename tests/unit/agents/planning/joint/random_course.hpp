// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/joint/course.hpp"
#include "agents/planning/joint/leg.hpp"
#include "tests/unit/common/collision/random_world.hpp"

namespace sidestep {

/// A few legs in a square, with random waits between them.
inline Course random_course(Rng& rng, int legs, double half_m) {
  Vec2 at = random_position(rng, half_m);
  Course course(Time{}, at);
  Time free{};
  for (int i = 0; i < legs; ++i) {
    const Vec2 to = random_position(rng, half_m);
    const Time start = free + from_seconds(rng.uniform(0, 0.5));
    course.append(make_leg(start, at, to, leg_times((to - at).norm(), MotionLimits{})));
    free = course.end();
    at = to;
  }
  return course;
}

}  // namespace sidestep
