// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "common/geometry/circle.hpp"
#include "idl/vision.hpp"

namespace sidestep {

/// Fills in a frame's obstacles, and the distance from the frame's robots up to which the list is complete.
/// If there are more obstacles than a frame holds, keeps those whose edges are nearest to a robot. Reorders
/// the given obstacles. Precondition: the frame's robots are filled in.
void set_obstacles(std::span<Circle> detected, msg::DetectionFrame& frame);

}  // namespace sidestep
