// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace sidestep {

/// Returns why a user-supplied heading in radians is invalid: it is not finite, or its magnitude exceeds a
/// full turn, which suggests degrees. Empty if it is valid.
[[nodiscard]] std::string heading_problem(double heading_rad);

}  // namespace sidestep
