// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace sidestep {

/// What is wrong with a heading in radians that a person has given: it is not finite, or beyond a whole turn,
/// so that it may be meant in degrees. Empty: nothing.
[[nodiscard]] std::string heading_problem(double heading_rad);

}  // namespace sidestep
