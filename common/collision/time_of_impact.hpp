// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/collision/shapes.hpp"
#include "common/collision/sweep.hpp"

namespace sidestep {

/// The part of the way, 0 to 1, after which the disc touches the shape for the first time. A way that touches
/// no more than rounding may be found to touch or not.
std::optional<double> time_of_impact(const Sweep& sweep, const Shape& shape);

}  // namespace sidestep
