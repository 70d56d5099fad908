// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "common/geometry/vec2.hpp"
#include "common/motion/limits.hpp"
#include "common/random/rng.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// Whether an acceleration lies in A(v), the set of accelerations that a robot may use at a velocity (Bruce,
/// CMU-CS-06-181, ch. 5): a half disc of radius F ahead of the velocity, and behind it a half ellipse that
/// reaches F sideways and D backwards. At rest A(v) is a disc of radius F.
[[nodiscard]] bool is_admissible(const Vec2& acceleration_mps2, const Vec2& velocity_mps,
                                 const MotionLimits& limits);

/// Whether the acceleration stays in A(v) while it is held for `duration` and v changes accordingly. A robot
/// that brakes at D beyond the point where its velocity reverses would accelerate at D.
[[nodiscard]] bool stays_admissible(const Vec2& acceleration_mps2, const Vec2& velocity_mps,
                                    const MotionLimits& limits, Duration duration);

/// An acceleration that may be held for `duration`: the requested one, reduced to the speed limit and scaled
/// into A(v). Precondition: the initial speed is within the limit.
Vec2 limit_acceleration(const Vec2& acceleration_mps2, const Vec2& velocity_mps, const MotionLimits& limits,
                        Duration duration);

/// Draws an acceleration uniformly from A(v).
Vec2 sample_acceleration(const Vec2& velocity_mps, const MotionLimits& limits, Rng& rng);

/// Draws `count` samples like sample_acceleration(), in a frame whose x axis is the velocity.
void sample_in_velocity_frame(bool is_at_rest, const MotionLimits& limits, Rng& rng, std::size_t count,
                              double* x_mps2, double* y_mps2);

/// Whether a velocity is too small to have a direction.
[[nodiscard]] bool is_at_rest(const Vec2& velocity_mps);

/// The direction of a velocity; the x axis at rest.
Vec2 forward_of(const Vec2& velocity_mps);

}  // namespace sidestep
