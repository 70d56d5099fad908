// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/vec2.hpp"
#include "agents/batch/kernels.hpp"
#include "common/motion/limits.hpp"
#include "common/random/rng.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// The set A(v) of accelerations that a robot may ask for at a velocity (Bruce, ch. 5): ahead of the velocity
/// a half disc of radius F, behind it a half ellipse that reaches F sideways and D backwards. At rest a disc
/// of radius F.
bool is_admissible(const Vec2& acceleration_mps2, const Vec2& velocity_mps, const MotionLimits& limits);

/// The acceleration in A(v) that points the same way and is nearest to what was asked for.
Vec2 scaled_into_model(const Vec2& acceleration_mps2, const Vec2& velocity_mps, const MotionLimits& limits);

/// As scaled_into_model, for an acceleration that is held for `duration`: after it the speed is within its
/// limit too, provided that the speed is within it now.
Vec2 limited(const Vec2& acceleration_mps2, const Vec2& velocity_mps, const MotionLimits& limits,
             Duration duration);

/// Uniform over A(v).
Vec2 sample(const Vec2& velocity_mps, const MotionLimits& limits, Rng& rng);

/// As sample(), with x along the velocity.
Vec2 sample_ahead(bool is_at_rest, const MotionLimits& limits, Rng& rng);

/// As many of them.
void sample_ahead(bool is_at_rest, const MotionLimits& limits, Rng& rng, std::size_t count, double* x_mps2,
                  double* y_mps2);

/// The direction of a velocity; along x at rest.
Vec2 forward_of(const Vec2& velocity_mps);

/// What batch::Kernels::limit takes to do as limited() does to many, drawn by sample_ahead().
batch::LimitSettings limit_settings(const Vec2& velocity_mps, const Vec2& desired_mps2,
                                    const MotionLimits& limits, Duration duration);

}  // namespace sidestep
