// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcl/geometry/collision_geometry.h>
#include <memory>

#include "common/collision/shapes.hpp"

namespace sidestep {

/// A geometry of FCL.
using Solid = std::shared_ptr<fcl::CollisionGeometryd>;

/// Extrudes a shape on the floor, half of the height upwards and half downwards, without moving its origin. A
/// circle becomes a polygon with 128 corners, a segment a vertical rectangle. Throws std::invalid_argument if
/// the shape is invalid or the height is not above 0.
[[nodiscard]] Solid prism(const Shape& shape, double height_m);

}  // namespace sidestep
