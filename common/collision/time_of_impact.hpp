// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/collision/shapes.hpp"
#include "common/collision/sweep.hpp"

namespace sidestep {

/// The fraction of the path, 0 to 1, after which the disc first touches the shape; nullopt without contact.
/// Contacts within rounding error may be reported either way.
[[nodiscard]] std::optional<double> time_of_impact(const Sweep& sweep, const Shape& shape);

}  // namespace sidestep
