// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/camera/camera_model.hpp"
#include "common/config/scenario.hpp"
#include "common/marking/layout.hpp"
#include "vision/colours/colour_learner.hpp"

namespace sidestep {

/// The discs in one camera's image of a known scene.
struct FloorLabels {
  std::vector<LabelledDisc> discs;    ///< dots and the ball
  std::vector<LabelledDisc> ignored;  ///< obstacles and opponents, whose colours are unknown
};

/// Labels for a scenario's floor at the start. Each robot has the marker pattern of its number; throws
/// std::invalid_argument if the layout lacks that pattern.
[[nodiscard]] FloorLabels floor_labels_at_start(const Scenario& scenario, const MarkerLayout& layout,
                                                const CameraModel& camera);

/// All colours of robots and ball on the whole floor at the start, each listed once. Precondition: the layout
/// has all patterns.
[[nodiscard]] std::vector<Colour> colours_at_start(const Scenario& scenario, const MarkerLayout& layout);

}  // namespace sidestep
