// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/camera/camera_model.hpp"
#include "common/config/scenario.hpp"
#include "common/marking/layout.hpp"
#include "vision/colours/colour_learner.hpp"

namespace sidestep {

/// What a camera sees of a floor on which is known what stands where.
struct KnownFloor {
  std::vector<KnownDisc> discs;    ///< dots and the ball
  std::vector<KnownDisc> unknown;  ///< obstacles and opponents, whose colours nobody knows
};

/// A scenario's floor before anything moves. Each robot wears the pattern of its number; throws
/// std::invalid_argument when the layout has no such pattern.
KnownFloor floor_at_start(const Scenario& scenario, const MarkingLayout& layout, const CameraModel& camera);

/// All colours that there are then on robots and ball, on whatever camera's part of the floor, each once.
/// Precondition: the layout has all patterns.
std::vector<Colour> colours_at_start(const Scenario& scenario, const MarkingLayout& layout);

}  // namespace sidestep
